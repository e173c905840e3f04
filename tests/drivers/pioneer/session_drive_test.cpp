// SPDX-License-Identifier: Apache-2.0
// What a connected robot is told: motors, set points, emergency stop, farewell.
#include <cmath>
#include <limits>

#include "tests/drivers/pioneer/session_fixture.hpp"

namespace deltamap::drivers::pioneer {
namespace {

TEST_F(PioneerSessionTest, NeverEnablesMotorsByDefault) {
  ASSERT_TRUE(connect());
  line.carry_out(session.drive({line.now, 0.3, 0.0}, line.now));
  line.run_for(5.0);
  EXPECT_EQ(times_obeyed(CommandNumber::kEnable), 0u);
  EXPECT_FALSE(robot.has_ever_moved);
}

TEST_F(PioneerSessionTest, EnablesMotorsWhereAllowedAndDrives) {
  use({.enable_motors = true, .drive_switch = DriveSwitch::kOn});
  ASSERT_TRUE(connect());
  line.run_for(2.0);
  ASSERT_TRUE(robot.motors_on);
  line.carry_out(session.drive({line.now, 0.3, -0.5}, line.now));
  line.run_for(0.1);
  EXPECT_EQ(robot.speed, 300);
  EXPECT_EQ(robot.turn_rate, -29);
  line.run_for(5.0);
  EXPECT_EQ(robot.speed, 300) << "set points are repeated";
  EXPECT_GT(line.messages.back().odom_from_robot.x, 1.0);
  EXPECT_FALSE(robot.watchdog_has_stopped);
  line.carry_out(session.stop_driving(line.now));
  line.run_for(0.1);
  EXPECT_FALSE(robot.moves);
}

TEST_F(PioneerSessionTest, NeitherEnablesNorDrivesARobotThatDoesNotTellItsWatchdog) {
  const auto mute = [](FakeRobot& r) { r.tells_config = false; };
  const auto ends_before_it = [](FakeRobot& r) { r.config.watchdog_ms.reset(); };
  for (const std::function<void(FakeRobot&)>& hides : {std::function<void(FakeRobot&)>{mute}, {ends_before_it}}) {
    use({.enable_motors = true, .drive_switch = DriveSwitch::kOn});
    robot = FakeRobot{9600};
    hides(robot);
    ASSERT_TRUE(connect());
    for (int i = 0; i < 60; ++i) {
      line.carry_out(session.drive({line.now, 0.3, 0.2}, line.now));
      line.run_for(0.2);
    }
    EXPECT_FALSE(session.stopping_limits().watchdog_s);
    EXPECT_EQ(session.why_never_driven(), "the robot does not tell its watchdog");
    EXPECT_EQ(times_obeyed(CommandNumber::kConfig), 5u);
    EXPECT_EQ(times_obeyed(CommandNumber::kEnable), 0u);
    robot.motors_on = true;  // a person's hand
    line.carry_out(session.drive({line.now, 0.3, 0.2}, line.now));
    line.run_for(0.5);
    EXPECT_FALSE(robot.has_ever_moved);
    EXPECT_EQ(std::count(line.log.begin(), line.log.end(), "robot does not tell its watchdog: it is not driven"), 1);
    EXPECT_TRUE(session.is_connected());
    line.log.clear();
    robot.outgoing.clear();
  }
}

TEST_F(PioneerSessionTest, SaysThatARobotWithoutAWatchdogIsNeverDriven) {
  ASSERT_TRUE(connect());
  line.run_for(2.0);
  EXPECT_EQ(session.why_never_driven(), "");
  use({.enable_motors = true, .drive_switch = DriveSwitch::kOn});
  robot = FakeRobot{9600};
  robot.config.watchdog_ms = 0;
  EXPECT_EQ(session.why_never_driven(), "") << "nobody knows yet";
  ASSERT_TRUE(connect());
  line.run_for(2.0);
  EXPECT_EQ(session.why_never_driven(), "the robot's watchdog is off: it would never stop by itself");
}

TEST_F(PioneerSessionTest, DrivesOnceALateConfigurationHasToldTheWatchdog) {
  use({.enable_motors = true, .drive_switch = DriveSwitch::kOn});
  robot.tells_config = false;
  ASSERT_TRUE(connect());
  line.run_for(2.5);
  EXPECT_EQ(times_obeyed(CommandNumber::kEnable), 0u);
  robot.tells_config = true;
  ASSERT_TRUE(line.run_until([&] { return session.config().has_value(); }, 1.5));
  line.run_for(0.3);
  EXPECT_EQ(times_obeyed(CommandNumber::kEnable), 1u);
  EXPECT_TRUE(robot.motors_on);
  // Of the next connection nothing is known again.
  robot.connected = robot.motors_on = false;
  line.run_for(1.0);
  ASSERT_TRUE(line.failed);
  line.failed.reset();
  robot.tells_config = false;
  ASSERT_TRUE(connect());
  line.run_for(2.5);
  EXPECT_EQ(times_obeyed(CommandNumber::kEnable), 1u);
}

TEST_F(PioneerSessionTest, ClampsSetPointsAndRefusesThoseThatAreNoNumbers) {
  use({.enable_motors = true,
       .drive_switch = DriveSwitch::kOn,
       .limits = {.max_speed_m_per_s = 0.25, .max_turn_rate_rad_per_s = 0.5}});
  ASSERT_TRUE(connect());
  line.run_for(1.0);
  line.carry_out(session.drive({line.now, 9.0, -9.0}, line.now));
  line.run_for(0.1);
  EXPECT_EQ(robot.speed, 250);
  EXPECT_EQ(robot.turn_rate, -29);
  line.carry_out(session.drive({line.now, std::nan(""), 0.0}, line.now));
  line.run_for(0.1);
  EXPECT_EQ(robot.speed, 0);
  EXPECT_EQ(robot.turn_rate, 0);
}

TEST_F(PioneerSessionTest, StopsInAnEmergencyUntilTheRobotStandsAndHoldsItThere) {
  use({.enable_motors = true, .drive_switch = DriveSwitch::kOn});
  ASSERT_TRUE(connect());
  ASSERT_TRUE(line.run_until([&] { return robot.motors_on; }, 3.0));
  line.carry_out(session.drive({line.now, 0.3, 0.2}, line.now));
  ASSERT_TRUE(line.run_until([&] { return robot.moves; }, 1.0));
  const std::size_t before = times_obeyed(CommandNumber::kEstop);
  robot.sip.left_mm_per_s = robot.sip.right_mm_per_s = 300;
  line.run_for(0.2);  // its SIPs say so
  robot.is_deaf = true;
  line.carry_out(session.emergency_stop(line.now));
  line.run_for(0.15);
  robot.is_deaf = false;  // the first was lost
  line.carry_out(session.emergency_stop(line.now));
  line.run_for(0.05);
  EXPECT_EQ(times_obeyed(CommandNumber::kEstop), before + 1);
  EXPECT_FALSE(robot.moves);
  robot.sip.left_mm_per_s = robot.sip.right_mm_per_s = 0;
  line.run_for(0.2);
  const std::size_t stood = robot.obeyed.size();
  for (int i = 0; i < 60; ++i) {  // 3 s, beyond its watchdog
    line.carry_out(session.emergency_stop(line.now));
    line.run_for(0.05);
  }
  EXPECT_FALSE(robot.watchdog_has_stopped);
  for (std::size_t i = stood; i < robot.obeyed.size(); ++i) {
    EXPECT_EQ(robot.obeyed[i].number, CommandNumber::kEstop) << i;  // and no old set point among them
  }
  EXPECT_LE(robot.obeyed.size() - stood, 8u);
  line.carry_out(session.drive({line.now, 0.3, 0.2}, line.now));  // the one that it had before
  EXPECT_TRUE(line.run_until([&] { return robot.moves; }, 1.0));
}

TEST_F(PioneerSessionTest, KeepsAnEmergencyStopUpUntilTheRobotIsToldToMove) {
  use({.enable_motors = true, .drive_switch = DriveSwitch::kOn});
  ASSERT_TRUE(connect());
  ASSERT_TRUE(line.run_until([&] { return robot.motors_on; }, 3.0));
  line.carry_out(session.drive({line.now, 0.3, 0.2}, line.now));
  ASSERT_TRUE(line.run_until([&] { return robot.moves; }, 1.0));
  line.carry_out(session.emergency_stop(line.now));
  line.run_for(0.1);
  robot.sip.left_mm_per_s = robot.sip.right_mm_per_s =
      300;  // it heeds no set point, and VEL 0 would withdraw the ESTOP
  const std::size_t begin = robot.obeyed.size();
  for (int i = 0; i < 20; ++i) {
    line.carry_out(session.drive({line.now, 0.0, 0.0}, line.now));
    line.run_for(0.05);
  }
  ASSERT_GT(robot.obeyed.size(), begin + 5);
  for (std::size_t i = begin; i < robot.obeyed.size(); ++i) {
    EXPECT_EQ(robot.obeyed[i].number, CommandNumber::kEstop) << i;
  }
  line.carry_out(session.drive({line.now, 0.0, 0.2}, line.now));
  line.run_for(0.1);
  EXPECT_NE(robot.turn_rate, 0);
}

TEST_F(PioneerSessionTest, DoesNotEnableMotorsAgainAfterTheStopButton) {
  use({.enable_motors = true, .drive_switch = DriveSwitch::kOn});
  ASSERT_TRUE(connect());
  line.run_for(2.0);
  ASSERT_TRUE(robot.motors_on);
  const std::size_t enabled = times_obeyed(CommandNumber::kEnable);
  robot.stop_button = true;
  robot.motors_on = false;
  line.run_for(3.0);
  EXPECT_TRUE(line.messages.back().stop_button);
  robot.stop_button = false;
  line.run_for(10.0);
  EXPECT_EQ(times_obeyed(CommandNumber::kEnable), enabled);
  EXPECT_FALSE(robot.motors_on);
}

TEST_F(PioneerSessionTest, DoesNotEnableMotorsWhileTheStopButtonIsHeldAtConnection) {
  use({.enable_motors = true, .drive_switch = DriveSwitch::kOn});
  robot.stop_button = true;
  ASSERT_TRUE(connect());
  line.run_for(5.0);
  EXPECT_EQ(times_obeyed(CommandNumber::kEnable), 0u);
}

TEST_F(PioneerSessionTest, TakesEstallForTheStopButton) {
  use({.enable_motors = true, .drive_switch = DriveSwitch::kOn});
  robot.estall = true;
  ASSERT_TRUE(connect());
  line.run_for(3.0);
  EXPECT_TRUE(session.stop_button_is_pressed()) << "`drive wander` is refused by this";
  EXPECT_TRUE(line.messages.back().stop_button);
  EXPECT_EQ(session.permission().drive_switch(), DriveSwitch::kOffAtRobot);
  line.carry_out(session.switch_drive(true, line.now));
  line.run_for(3.0);
  robot.connected = false;  // a reset
  line.run_for(1.0);
  ASSERT_TRUE(line.failed);
  line.failed.reset();
  ASSERT_TRUE(connect());
  line.run_for(3.0);
  robot.estall = false;
  line.run_for(3.0);
  EXPECT_EQ(times_obeyed(CommandNumber::kEnable), 0u);
  line.carry_out(session.switch_drive(true, line.now));
  line.run_for(3.0);
  EXPECT_TRUE(robot.motors_on) << "a person has said so after it";
}

TEST_F(PioneerSessionTest, TakesItsLeaveWithARobotThatStands) {
  use({.enable_motors = true, .drive_switch = DriveSwitch::kOn});
  ASSERT_TRUE(connect());
  line.run_for(2.0);
  line.carry_out(session.drive({line.now, 0.3, 0.0}, line.now));
  line.run_for(1.0);
  robot.sip.left_mm_per_s = robot.sip.right_mm_per_s = 300;
  line.run_for(0.2);
  line.carry_out(session.close(line.now));
  line.run_for(0.3);
  EXPECT_NE(line.written.back().bytes, kCloseFrame) << "it brakes: CLOSE would let it roll";
  EXPECT_TRUE(session.is_leaving());
  line.run_for(0.9);
  EXPECT_EQ(line.written.back().bytes, kCloseFrame);
  EXPECT_FALSE(session.is_leaving());
  EXPECT_FALSE(line.wake_at);
  EXPECT_FALSE(line.failed);
  EXPECT_FALSE(robot.connected);
  EXPECT_EQ(robot.lost, 0) << "the farewell keeps its distance (A1)";
  const std::size_t written = line.written.size();
  line.run_for(3.0);
  line.carry_out(session.drive({line.now, 0.3, 0.0}, line.now));
  EXPECT_EQ(line.written.size(), written) << "nothing is sent after the leave";
}

/// Speed and deceleration are the controller's word, and some of it is damaged or absurd.
TEST_F(PioneerSessionTest, LeavesInTimeWhateverTheControllerReports) {
  constexpr double kFarewell_s = 3.5;
  struct Report {
    std::int16_t speed_mm_per_s;
    std::uint16_t deceleration_mm_per_s2;
  };
  const std::vector<Report> reports{{32767, 1000}, {-32768, 1000}, {32767, 1},  {400, 1},
                                    {1, 1},        {400, 0},       {25000, 300}};
  for (const Report& report : reports) {
    use({.enable_motors = true, .drive_switch = DriveSwitch::kOn});
    robot = FakeRobot{9600};
    robot.takes_limits = false;
    robot.config.trans_decel = report.deceleration_mm_per_s2;
    ASSERT_TRUE(connect());
    line.run_for(2.0);
    robot.sip.left_mm_per_s = report.speed_mm_per_s;
    line.run_for(0.3);
    const Timestamp asked = line.now;
    line.log.clear();
    line.carry_out(session.close(line.now));
    EXPECT_TRUE(line.run_until([&] { return !session.is_leaving(); }, 600.0));
    EXPECT_LT(seconds(line.now - asked), kFarewell_s) << report.speed_mm_per_s << " " << report.deceleration_mm_per_s2;
    const std::vector<Command> last(robot.obeyed.end() - 4, robot.obeyed.end());
    const bool is_closed = last.back().number == CommandNumber::kClose;
    const std::size_t first = is_closed ? 0 : 1;
    EXPECT_EQ(last[first].number, CommandNumber::kEstop);
    EXPECT_EQ(last[first + 1], (Command{CommandNumber::kVel, 0}));
    EXPECT_EQ(last[first + 2], (Command{CommandNumber::kRvel, 0}));
    EXPECT_EQ(is_closed, !line.has_logged("is told to stop and not let go")) << "CLOSE would let it roll on";
  }
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
