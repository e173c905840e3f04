// SPDX-License-Identifier: Apache-2.0
// When a scan does not follow from the one before.
#include "localization/belief/scan_break.hpp"

#include <gtest/gtest.h>

#include "tests/localization/belief/aisle_drive.hpp"

namespace deltamap::localization::belief {
namespace {

TEST(ScanBreak, IsNoneWhereTheRobotDrivesOnItsOwnWheels) {
  AisleDrive robot;
  ScanBreak scans{{.most = 0.08, .most_one_way = 0.08}};
  for (int i = 0; i < 300; ++i) ASSERT_FALSE(scans.observe(robot.next())) << i;
}

TEST(ScanBreak, IsSeenInTheFirstScanOfACarriedRobot) {
  AisleDrive robot;
  ScanBreak scans{{}};
  for (int i = 0; i < 20; ++i) ASSERT_FALSE(scans.observe(robot.next()));
  robot.carried_m = 2.5;
  EXPECT_TRUE(scans.observe(robot.next()));
  EXPECT_FALSE(scans.observe(robot.next()));
}

TEST(ScanBreak, IsNoneWhereAThingComesOrGoes) {
  AisleDrive robot;
  ScanBreak scans{{}};
  for (int i = 0; i < 20; ++i) (void)scans.observe(robot.next());
  for (const int thing_beams : {45, 45, 0}) EXPECT_FALSE(scans.observe(robot.next(thing_beams)));
}

TEST(ScanBreak, IsOneWhereAThirdOfTheViewIsNearer) {
  AisleDrive robot;
  ScanBreak scans{{}};
  for (int i = 0; i < 20; ++i) (void)scans.observe(robot.next());
  EXPECT_TRUE(scans.observe(robot.next(70)));
}

TEST(ScanBreak, IsNoneWhereTheWheelsHaveSlippedAndTheEstimateHasNot) {
  AisleDrive robot;
  ScanBreak scans{{.most = 0.08, .most_one_way = 0.08}};
  for (int i = 0; i < 20; ++i) (void)scans.observe(robot.next());
  robot.map_from_odom.x = robot.carried_m = -0.6;  // so much the wheels counted and the body did not go
  for (int i = 0; i < 20; ++i) ASSERT_FALSE(scans.observe(robot.next())) << i;
}

TEST(ScanBreak, IsOneAfterAWayWithoutScansOverWhichTheWheelsMayBeOff) {
  AisleDrive robot;
  ScanBreak scans{{}};
  (void)scans.observe(robot.next());
  robot.speed_m_per_s = 2.0 / AisleDrive::kPeriodS;
  EXPECT_FALSE(scans.observe(robot.next()));
  robot.speed_m_per_s = 4.0 / AisleDrive::kPeriodS;
  EXPECT_TRUE(scans.observe(robot.next()));
}

}  // namespace
}  // namespace deltamap::localization::belief
