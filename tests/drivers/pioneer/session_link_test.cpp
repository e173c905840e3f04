// SPDX-License-Identifier: Apache-2.0
// The connection that is kept: watchdog, silence, limits, a faster line; and the same in a recording.
#include "tests/drivers/pioneer/session_fixture.hpp"

namespace deltamap::drivers::pioneer {
namespace {

TEST_F(PioneerSessionTest, StopsARobotThatHasFallenSilentAndDoesNotCloseIt) {
  ASSERT_TRUE(connect());
  line.run_for(1.0);
  robot.is_mute = true;
  line.run_for(3.0);
  ASSERT_TRUE(line.failed);
  const auto& heard = robot.obeyed;
  ASSERT_GE(heard.size(), 3u);
  EXPECT_EQ(heard[heard.size() - 3].number, CommandNumber::kEstop);
  EXPECT_EQ(heard[heard.size() - 2], (Command{CommandNumber::kVel, 0}));
  EXPECT_EQ(heard[heard.size() - 1], (Command{CommandNumber::kRvel, 0}));
  EXPECT_TRUE(robot.connected) << "CLOSE would wipe out what a button has done meanwhile";
  EXPECT_EQ(robot.lost, 0);
}

TEST_F(PioneerSessionTest, SetsLimitsAndReadsThemBack) {
  use({.limits = {.max_speed_m_per_s = 0.5, .deceleration_m_per_s2 = 0.8}});
  robot.config.watchdog_ms = 700;
  ASSERT_TRUE(connect());
  EXPECT_FALSE(session.stopping_limits().watchdog_s);
  EXPECT_EQ(session.stopping_limits().deceleration_m_per_s2, 0.3) << "as delivered, until it has said otherwise";
  line.run_for(1.5);
  EXPECT_EQ(robot.config.trans_vel_max, 500);
  EXPECT_EQ(robot.config.trans_acc, 300);
  EXPECT_EQ(robot.config.trans_decel, 800);
  EXPECT_EQ(robot.config.rot_decel, 150);
  EXPECT_DOUBLE_EQ(session.stopping_limits().deceleration_m_per_s2, 0.8);
  EXPECT_DOUBLE_EQ(session.stopping_limits().watchdog_s.value_or(0.0), 0.7);
  EXPECT_EQ(times_obeyed(CommandNumber::kSetV), 1u) << "no more once they show";
  EXPECT_TRUE(line.has_logged("keeps to its limits: deceleration=0.80 m/s^2"));
}

TEST_F(PioneerSessionTest, GoesByWhatTheControllerReportsWhereItTakesNoLimits) {
  robot.takes_limits = false;
  robot.config.trans_decel = 250;
  ASSERT_TRUE(connect());
  line.run_for(20.0);
  EXPECT_EQ(times_obeyed(CommandNumber::kSetV), 5u);
  EXPECT_DOUBLE_EQ(session.stopping_limits().deceleration_m_per_s2, 0.25);
  EXPECT_TRUE(line.has_logged("has its own: deceleration=0.25 m/s^2"));
}

TEST_F(PioneerSessionTest, TellsLowBatteryByTheControllersOwnThresholdAndItsFaults) {
  robot.config.low_battery_decivolts = 115;
  robot.sip.battery_decivolts = 116;
  ASSERT_TRUE(connect());
  line.run_for(1.0);
  EXPECT_FALSE(line.messages.back().low_battery);
  EXPECT_EQ(line.messages.back().fault_flags, 0);
  robot.sip.battery_decivolts = 115;
  line.run_for(0.3);
  EXPECT_TRUE(line.messages.back().low_battery);
  robot.sip.grip_state = robot.sip.analog_port = robot.sip.analog = std::uint8_t{0};
  robot.sip.digital_in = robot.sip.digital_out = std::uint8_t{0};
  robot.sip.battery_x10_decivolts = std::uint16_t{128};
  robot.sip.charge_state = std::uint8_t{0};
  robot.sip.turn_rate_decideg_per_s = std::int16_t{0};
  robot.sip.fault_flags = std::uint16_t{0x0104};
  line.run_for(0.3);
  EXPECT_FALSE(line.messages.back().low_battery) << "the finer voltage counts";
  EXPECT_EQ(line.messages.back().fault_flags, 0x0104);
}

TEST_F(PioneerSessionTest, FeedsTheWatchdogWhileIdle) {
  ASSERT_TRUE(connect());
  line.run_for(10.0);
  EXPECT_FALSE(robot.watchdog_has_stopped);
  EXPECT_TRUE(session.is_connected());
}

TEST_F(PioneerSessionTest, FeedsAWatchdogThatIsShorterThanUsual) {
  robot.config.watchdog_ms = 400;
  ASSERT_TRUE(connect());
  line.run_for(2.0);
  robot.watchdog_has_stopped = false;
  line.run_for(5.0);
  EXPECT_FALSE(robot.watchdog_has_stopped);
  EXPECT_FALSE(line.has_logged("not spoken to"));
}

TEST_F(PioneerSessionTest, StopsTheRobotFirstAfterAGapInItsOwnSending) {
  use({.enable_motors = true, .drive_switch = DriveSwitch::kOn});
  ASSERT_TRUE(connect());
  line.run_for(2.0);
  line.carry_out(session.drive({line.now, 0.3, 0.0}, line.now));
  line.run_for(1.0);
  ASSERT_TRUE(robot.moves);
  // The process stalls: nothing is written for three seconds, the watchdog stops the robot.
  line.now += std::chrono::seconds{3};
  robot.tick(line.now);
  ASSERT_TRUE(robot.watchdog_has_stopped);
  robot.outgoing.clear();
  const std::size_t before = robot.obeyed.size();
  line.carry_out(session.on_bytes(encoded_sip(robot.sip), line.now));
  robot.has_ever_moved = false;
  line.run_for(1.0);
  ASSERT_GT(robot.obeyed.size(), before + 1);
  EXPECT_EQ(robot.obeyed[before], (Command{CommandNumber::kVel, 0}));
  EXPECT_EQ(robot.obeyed[before + 1], (Command{CommandNumber::kRvel, 0}));
  EXPECT_FALSE(robot.has_ever_moved);
  EXPECT_TRUE(line.has_logged("not spoken to"));
}

TEST_F(PioneerSessionTest, FailsWhenSipsStopAndComesBackInANewEpoch) {
  ASSERT_TRUE(connect());
  line.run_for(1.0);
  robot.is_mute = true;
  line.run_for(3.0);
  ASSERT_TRUE(line.failed);
  EXPECT_EQ(*line.failed, "robot has been silent for 1000 ms");
  const std::uint32_t epoch = line.messages.back().epoch;
  robot.is_mute = false;
  line.failed.reset();
  ASSERT_TRUE(connect());
  line.run_for(0.5);
  EXPECT_EQ(line.messages.back().epoch, epoch + 1);
}

TEST_F(PioneerSessionTest, NoticesThatTheRobotWasReset) {
  ASSERT_TRUE(connect());
  line.run_for(1.0);
  robot.connected = false;  // waits for a connection, and echoes PULSE as SYNC0
  line.run_for(0.9);
  ASSERT_TRUE(line.failed);
  EXPECT_EQ(*line.failed, "robot was reset: it waits for a connection");
}

TEST_F(PioneerSessionTest, SwitchesToAFasterLineWhereTheRobotAllowsIt) {
  use({.fast_baud = 38400});
  robot.config.auto_baud = 1;
  ASSERT_TRUE(connect());
  line.run_for(2.0);
  EXPECT_EQ(session.baud(), 38400u);
  EXPECT_EQ(robot.baud(), 38400u);
  EXPECT_TRUE(session.is_connected());
  line.run_for(5.0);
  EXPECT_FALSE(robot.watchdog_has_stopped);
  EXPECT_FALSE(line.failed);
}

TEST_F(PioneerSessionTest, StaysAtItsSpeedWhereTheRobotForbidsAnother) {
  use({.fast_baud = 38400});
  robot.config.auto_baud = 0;
  ASSERT_TRUE(connect());
  line.run_for(2.0);
  EXPECT_EQ(times_obeyed(CommandNumber::kHostBaud), 0u);
  EXPECT_EQ(session.baud(), 9600u);
}

TEST_F(PioneerSessionTest, GoesBackToTheOldSpeedWhereTheRobotDoesNotFollow) {
  use({.fast_baud = 115200});
  robot.config.auto_baud = 2;
  robot.follows_host_baud = false;
  ASSERT_TRUE(connect());
  line.run_for(4.0);
  EXPECT_EQ(session.baud(), 9600u);
  EXPECT_TRUE(session.is_connected());
  EXPECT_TRUE(line.has_logged("did not follow"));
}

TEST_F(PioneerSessionTest, ListeningToTheRecordingGivesTheSameOdometryAndWritesNothing) {
  use({.enable_motors = true, .drive_switch = DriveSwitch::kOn});
  robot.config.kinematics_delay_ms = 20;
  ASSERT_TRUE(connect());
  line.run_for(1.0);
  line.carry_out(session.drive({line.now, 0.3, 0.0}, line.now));
  for (const std::size_t piece : {std::size_t{20}, std::size_t{62}, std::size_t{4096}}) {
    line.run_for(1.0);
    line.stand_still_for(0.9, piece);
  }
  line.run_for(1.0);
  for (std::size_t i = 1; i < line.messages.size(); ++i) {
    EXPECT_GT(line.messages[i].time, line.messages[i - 1].time) << i;
  }
  PioneerSession listener{PioneerParams{.model = "p3dx"}, SessionMode::kListenOnly};
  EXPECT_TRUE(listener.start(line.now).output.requests.empty());
  std::vector<Odometry> heard;
  for (const tests::SentBytes& chunk : line.received) {
    const PioneerOutput out = listener.on_bytes(chunk.bytes, chunk.at);
    EXPECT_TRUE(out.output.requests.empty());
    EXPECT_FALSE(out.output.wake_at);
    heard.insert(heard.end(), out.odometry.begin(), out.odometry.end());
  }
  ASSERT_EQ(heard.size(), line.messages.size());
  for (std::size_t i = 0; i < heard.size(); ++i) {
    EXPECT_EQ(heard[i].time, line.messages[i].time);
    EXPECT_EQ(heard[i].odom_from_robot, line.messages[i].odom_from_robot);
    EXPECT_EQ(heard[i].epoch, line.messages[i].epoch);
  }
  EXPECT_TRUE(listener.on_time(line.now + std::chrono::hours{1}).output.requests.empty());
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
