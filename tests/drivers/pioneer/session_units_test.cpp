// SPDX-License-Identifier: Apache-2.0
// By which units a robot is read and driven, and whether it is driven at all.
#include "tests/drivers/pioneer/session_fixture.hpp"

namespace deltamap::drivers::pioneer {
namespace {

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

}  // namespace
}  // namespace deltamap::drivers::pioneer
