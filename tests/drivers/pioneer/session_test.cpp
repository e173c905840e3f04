// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/session.hpp"

#include "core/random.hpp"
#include "tests/drivers/pioneer/session_fixture.hpp"
#include "tests/support/bytes/damage.hpp"

namespace deltamap::drivers::pioneer {
namespace {

TEST_F(PioneerSessionTest, ConnectsAndDecodesOdometry) {
  ASSERT_TRUE(connect(2.0));
  line.run_for(1.0);
  EXPECT_GE(line.messages.size(), 9u);
  EXPECT_EQ(session.identity()->subtype, "p3dx-sh");
  ASSERT_TRUE(session.config());
  EXPECT_EQ(session.config()->watchdog_ms, 2000);
  EXPECT_FALSE(robot.sonar_on) << "nobody asked for sonar";
  EXPECT_EQ(robot.lost, 0) << "commands kept their distance";
}

TEST_F(PioneerSessionTest, FindsTheRobotAtAnyBaud) {
  robot = FakeRobot{57600};
  ASSERT_TRUE(connect());
  EXPECT_EQ(session.baud(), 57600u);
}

TEST_F(PioneerSessionTest, NamesTheSpeedsItTriedWhenNobodyAnswers) {
  robot.is_deaf = true;
  EXPECT_FALSE(connect(60.0));
  ASSERT_TRUE(line.failed);
  EXPECT_EQ(*line.failed,
            "robot does not answer at 9600, 38400, 115200, 19200, 57600 baud: no bytes came: switched off, or not "
            "connected");
  EXPECT_FALSE(line.wake_at);
}

TEST_F(PioneerSessionTest, FindsALaserOnItsPortInTheSecondSearch) {
  robot.is_deaf = true;
  const auto question = LineDiagnosis::question_to_a_laser();
  const auto times_asked = [&] {
    return std::count_if(line.written.begin(), line.written.end(), [&](const auto& w) { return w.bytes == question; });
  };
  EXPECT_FALSE(connect(60.0));
  EXPECT_EQ(times_asked(), 0) << "nothing foreign goes to a robot that may be about to answer";
  line.failed.reset();
  line.start();
  ASSERT_TRUE(line.run_until([&] { return times_asked() > 0; }, 5.0));
  const auto type = tests::bytes_from_hex("06 02801700ba4c4d533230303b3330313036333b5630322e313020102261");
  line.carry_out(session.on_bytes(type, line.now));
  line.run_for(60.0);
  ASSERT_TRUE(line.failed);
  EXPECT_TRUE(line.failed->ends_with("baud: the ports are swapped: the laser speaks on the robot's port"));
}

TEST_F(PioneerSessionTest, KeepsTheDistanceOfCommandsAfterTheQuestionToALaser) {
  robot.is_deaf = true;
  EXPECT_FALSE(connect(60.0));
  line.failed.reset();
  line.written.clear();
  line.start();
  line.run_for(60.0);
  ASSERT_TRUE(line.failed);
  constexpr Duration kLeastGap = std::chrono::milliseconds{5};  // A1
  const auto question = LineDiagnosis::question_to_a_laser();
  int asked = 0;
  Timestamp free_at;  // of the line
  for (const tests::WrittenBytes& written : line.written) {
    if (written.bytes.empty()) continue;  // a change of speed
    EXPECT_GE(seconds(written.at - free_at), seconds(kLeastGap)) << "at " << written.baud;
    free_at = written.at + line_time(written.bytes.size(), written.baud);
    asked += written.bytes == question ? 1 : 0;
  }
  EXPECT_GE(asked, 5);
}

TEST_F(PioneerSessionTest, ConnectsToARobotThatWakesUpWhileALaserIsAskedFor) {
  robot.is_deaf = true;
  EXPECT_FALSE(connect(60.0));
  line.failed.reset();
  robot.is_deaf = false;
  EXPECT_TRUE(connect());
}

TEST_F(PioneerSessionTest, StopsALeftOverRobotBeforeAnythingCouldMakeItResume) {
  for (const int closes_to_lose : {0, 1}) {
    robot = FakeRobot{9600};
    robot.be_left_over(300);
    robot.closes_to_lose = closes_to_lose;
    line.failed.reset();
    ASSERT_TRUE(connect()) << closes_to_lose;
    line.run_for(1.0);
    EXPECT_FALSE(robot.has_ever_moved) << closes_to_lose;
    EXPECT_TRUE(line.has_logged("still connected"));
  }
}

TEST_F(PioneerSessionTest, SendsNoCloseToARobotThatWaitsForAConnection) {
  ASSERT_TRUE(connect());
  const auto is_close = [](const tests::WrittenBytes& written) { return written.bytes == kCloseFrame; };
  EXPECT_EQ(std::count_if(line.written.begin(), line.written.end(), is_close), 1) << "SYNC2 alone";
  robot.connected = false;  // a reset
  line.run_for(1.0);
  ASSERT_TRUE(line.failed);
  EXPECT_EQ(std::count_if(line.written.begin(), line.written.end(), is_close), 1);
}

TEST_F(PioneerSessionTest, FindsARobotThatWasLeftAtTheFastBaudAndThenWaitsAtItsOwn) {
  use({.fast_baud = 38400});
  robot = FakeRobot{38400};
  robot.be_left_over(300);
  robot.idle_baud = 9600;
  ASSERT_TRUE(connect(2.0));
  EXPECT_EQ(robot.baud(), 9600u);
  EXPECT_FALSE(robot.has_ever_moved);
}

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

TEST_F(PioneerSessionTest, StartsOverWhenSyncIsAnsweredWithNonsense) {
  robot.sync1_to_garble = 1;
  ASSERT_TRUE(connect());
}

TEST_F(PioneerSessionTest, ConnectsThroughNoiseBetweenPackets) {
  Random random{19};
  robot.be_left_over(300);
  ASSERT_TRUE(connect());
  for (int i = 0; i < 300; ++i) {
    line.run_for(0.03);
    line.carry_out(session.on_bytes(tests::random_bytes(1 + random.index_below(8), random), line.now));
  }
  EXPECT_TRUE(session.is_connected());
  EXPECT_FALSE(robot.has_ever_moved);
  EXPECT_GT(session.counts().garbage_bytes, 300u);
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

TEST_F(PioneerSessionTest, TakesTheModelFromTheRobotAndItsLatencyFromItsConfiguration) {
  robot.identity.subtype = "p3dx";
  robot.config.subtype = "p3dx";
  robot.config.kinematics_delay_ms = 30;
  use({.enable_motors = true, .drive_switch = DriveSwitch::kOn});
  ASSERT_TRUE(connect());
  line.run_for(3.0);
  const double x_before = line.messages.back().odom_from_robot.x;
  const auto counted_before = robot.sip.x_units;
  line.carry_out(session.drive({line.now, 0.3, 0.0}, line.now));
  line.run_for(1.0);
  const double units = robot.sip.x_units - counted_before;
  EXPECT_NEAR(line.messages.back().odom_from_robot.x - x_before, units * 0.000485, 0.03);
  const Duration age = line.now - line.messages.back().time;
  EXPECT_GE(age, std::chrono::milliseconds{30} + line_time(24, 9600)) << "latency, and the line time of 24 bytes";
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

TEST_F(PioneerSessionTest, NeitherEnablesNorDrivesARobotWhoseSubtypeNobodyKnows) {
  for (const char* subtype : {"p3at", "powerbot-sh", "", "p3dxe", "x\x1b[31m"}) {
    use({.enable_motors = true, .drive_switch = DriveSwitch::kOn});
    robot = FakeRobot{9600};
    robot.identity.subtype = robot.config.subtype = subtype;
    ASSERT_TRUE(connect()) << subtype;
    line.carry_out(session.drive({line.now, 0.3, 0.2}, line.now));
    line.run_for(2.0);
    EXPECT_EQ(times_obeyed(CommandNumber::kEnable), 0u) << subtype;
    robot.motors_on = true;  // a person's hand
    line.run_for(0.5);
    line.carry_out(session.drive({line.now, 0.3, 0.2}, line.now));
    line.run_for(1.0);
    EXPECT_FALSE(robot.has_ever_moved) << subtype;
    EXPECT_NE(
        session.why_never_driven().find("is unknown: set its hull (navigation.safety.robot_radius_m) and its unit "
                                        "(robot.distance_unit_mm) by hand"),
        std::string_view::npos)
        << session.why_never_driven();
    ASSERT_EQ(line.warnings.size(), 1u) << "once, though the configuration says it again";
    EXPECT_TRUE(line.warnings[0].starts_with("robot is not driven: its subtype \"")) << line.warnings[0];
    EXPECT_EQ(line.warnings[0].find('\x1b'), std::string::npos);
    line.warnings.clear();
    robot.outgoing.clear();
  }
}

TEST_F(PioneerSessionTest, DrivesAnUnknownRobotByHullAndUnitThatAreSetByHand) {
  for (const RobotByHand& half : {RobotByHand{.metres_per_unit = 0.000465}, RobotByHand{.hull_m = 0.5}}) {
    use({.by_hand = half, .enable_motors = true, .drive_switch = DriveSwitch::kOn});
    robot = FakeRobot{9600};
    robot.identity.subtype = robot.config.subtype = "p3at";
    ASSERT_TRUE(connect());
    line.run_for(2.0);
    EXPECT_EQ(times_obeyed(CommandNumber::kEnable), 0u);
    EXPECT_NE(session.why_never_driven(), "");
    line.warnings.clear();
    robot.outgoing.clear();
  }
  use({.by_hand = {0.000465, 0.5}, .enable_motors = true, .drive_switch = DriveSwitch::kOn});
  robot = FakeRobot{9600};
  robot.identity.subtype = robot.config.subtype = "p3at";
  ASSERT_TRUE(connect());
  line.run_for(2.0);
  EXPECT_EQ(session.why_never_driven(), "");
  EXPECT_EQ(line.warnings, std::vector<std::string>{"robot subtype \"p3at\" is unknown: taken for what is set by hand: "
                                                    "hull radius 0.5 m, 0.465 mm a unit"});
  const double x_before = line.messages.back().odom_from_robot.x;
  const auto counted_before = robot.sip.x_units;
  line.carry_out(session.drive({line.now, 0.3, 0.0}, line.now));
  line.run_for(2.0);
  EXPECT_TRUE(robot.moves);
  const double units = robot.sip.x_units - counted_before;
  EXPECT_GT(units, 100.0);
  EXPECT_NEAR(line.messages.back().odom_from_robot.x - x_before, units * 0.000465, 0.03);
}

TEST_F(PioneerSessionTest, TakesTheUnitsThatTheControllerTellsBeforeThoseOfTheSettings) {
  robot.identity.subtype = robot.config.subtype = "p3dx-sh-lms500";
  use({.model = "p3dx", .enable_motors = true, .drive_switch = DriveSwitch::kOn});
  ASSERT_TRUE(connect());
  line.run_for(2.0);
  EXPECT_EQ(session.why_never_driven(), "");
  EXPECT_TRUE(
      line.has_logged("robot subtype \"p3dx-sh-lms500\" counts in units of 1 mm: that is used, not "
                      "robot.model=p3dx"));
  EXPECT_TRUE(line.warnings.empty());
  const double x_before = line.messages.back().odom_from_robot.x;
  const auto counted_before = robot.sip.x_units;
  line.carry_out(session.drive({line.now, 0.3, 0.0}, line.now));
  line.run_for(2.0);
  const double units = robot.sip.x_units - counted_before;
  EXPECT_GT(units, 100.0);
  EXPECT_NEAR(line.messages.back().odom_from_robot.x - x_before, units * 0.001, 0.04);
}

TEST_F(PioneerSessionTest, DoesNotDriveByUnitsThatContradictEachOther) {
  robot.identity.subtype = robot.config.subtype = "p3dx-sh";
  use({.by_hand = {0.000465, 0.5}, .enable_motors = true, .drive_switch = DriveSwitch::kOn});
  ASSERT_TRUE(connect());
  line.run_for(2.0);
  EXPECT_EQ(times_obeyed(CommandNumber::kEnable), 0u);
  EXPECT_EQ(session.why_never_driven(),
            "it is a \"p3dx-sh\" of 1 mm a unit, robot.distance_unit_mm says 0.465 mm: leave that key out, or set the "
            "right subtype in its controller");
  use({.by_hand = {0.001, 0.26}, .enable_motors = true, .drive_switch = DriveSwitch::kOn});
  robot = FakeRobot{9600};
  ASSERT_TRUE(connect());
  line.run_for(2.0);
  EXPECT_EQ(session.why_never_driven(), "") << "both say the same";
  use({.enable_motors = true, .drive_switch = DriveSwitch::kOn});
  robot = FakeRobot{9600};
  robot.config.subtype = "p3at";
  ASSERT_TRUE(connect());
  line.run_for(2.0);
  EXPECT_EQ(session.why_never_driven(), "it calls itself \"p3dx-sh\" and \"p3at\": set one subtype in its controller");
}

TEST(PioneerSessionParams, AreRefusedWithAReason) {
  EXPECT_THROW((PioneerSession{{.model = "at"}, SessionMode::kLive}), std::invalid_argument);
  EXPECT_THROW((PioneerSession{{.baud = 4800}, SessionMode::kLive}), std::invalid_argument);
  EXPECT_THROW((PioneerSession{{.fast_baud = 1}, SessionMode::kLive}), std::invalid_argument);
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
