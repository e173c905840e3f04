// SPDX-License-Identifier: Apache-2.0
#include "localization/odometer/laser_odometer.hpp"

#include <gtest/gtest.h>

#include "tests/localization/odometer/odometer_drive.hpp"
#include "tests/support/worlds/room_and_corridor.hpp"

namespace deltamap::localization::odometer {
namespace {

const Pose2 kInRoom{2.0, 3.0, 0.0};
const Pose2 kForward{0.08, 0.0, 0.0};
const Pose2 kArc{0.06, 0.0, 0.08};

/// How far the answer's motion is off that from one true pose to another.
Pose2 off(const Pose2& start, const Pose2& end, const Pose2& start_from_robot) {
  return motion_between(motion_between(start, end), start_from_robot);
}

TEST(LaserOdometer, IsRightWhereTheWheelsDrift) {
  const OccupancyGrid world = test::room_with_pillar();
  OdometerDrive drive{world, kInRoom};
  for (int i = 0; i < 150; ++i) (void)drive.step(kArc, {1.05 * kArc.x, 0.0, 0.95 * kArc.theta});
  const Pose2 wrong = off(kInRoom, drive.truth(), drive.odometer().start_from_robot());
  EXPECT_LT(wrong.position().norm(), 0.25);        // cells of 0.1 m, after 9 m and two rounds
  EXPECT_LT(std::abs(wrong.theta), radians(6.0));  // the wheels: 34°
}

TEST(LaserOdometer, BelievesWheelsThatAreRight) {
  const OccupancyGrid world = test::room_with_pillar();
  OdometerDrive drive{world, kInRoom};
  for (int i = 0; i < 40; ++i) EXPECT_FALSE(drive.step(i < 20 ? kForward : kArc).slip) << i;
}

/// Wheels that err too little from scan to scan to be contradicted.
TEST(LaserOdometer, TakesTheirPlaceWhereItLeads) {
  const OccupancyGrid world = test::room_with_pillar();
  const Pose2 claimed{1.05 * kArc.x, 0.0, 0.95 * kArc.theta};
  for (const bool leads : {false, true}) {
    OdometerDrive drive{world, kInRoom};
    drive.leads = leads;
    int corrected = 0;
    for (int i = 0; i < 150; ++i) corrected += drive.step(kArc, claimed).slip ? 1 : 0;
    const double turned_off = std::abs(off(kInRoom, drive.truth(), drive.odom_from_robot()).theta);
    EXPECT_EQ(turned_off < radians(6.0), leads) << degrees(turned_off);
    EXPECT_EQ(corrected > 140, leads) << corrected;
  }
}

TEST(LaserOdometer, NoticesWheelsThatSpinAtOnceAndLeavesTheRobotWhereItStands) {
  const OccupancyGrid world = test::room_with_pillar();
  OdometerDrive drive{world, kInRoom};
  for (int i = 0; i < 15; ++i) (void)drive.step(kForward);
  double stood_m = 0.0;
  for (int i = 0; i < 50; ++i) {
    const LaserMotion seen = drive.step({}, kForward);
    EXPECT_TRUE(seen.contradicts) << i;
    EXPECT_GE(seen.stood_m, stood_m) << i;
    stood_m = seen.stood_m;
  }
  EXPECT_NEAR(stood_m, 4.0, 0.1);
  EXPECT_LT(off(kInRoom, drive.truth(), drive.odom_from_robot()).position().norm(), 0.03);
  // It drives on, and is believed.
  for (int i = 0; i < 15; ++i) (void)drive.step(kForward);
  EXPECT_EQ(drive.step(kForward).stood_m, 0.0);
  EXPECT_LT(off(kInRoom, drive.truth(), drive.odom_from_robot()).position().norm(), 0.06);
}

TEST(LaserOdometer, NoticesASlipOfHeading) {
  const OccupancyGrid world = test::room_with_pillar();
  for (const double slip_deg : {-20.0, 12.0, 30.0}) {
    OdometerDrive drive{world, kInRoom};
    for (int i = 0; i < 10; ++i) (void)drive.step(kForward);
    const LaserMotion seen = drive.step(kForward, kForward * Pose2{0.0, 0.0, radians(slip_deg)});
    EXPECT_TRUE(seen.contradicts) << slip_deg;
    for (int i = 0; i < 5; ++i) (void)drive.step(kForward);
    EXPECT_LT(std::abs(off(kInRoom, drive.truth(), drive.odom_from_robot()).theta), radians(1.5)) << slip_deg;
  }
}

/// Along a bare corridor scans know nothing of the way: the wheels rule, and a robot that drives is not said to stand.
TEST(LaserOdometer, LetsTheWheelsRuleAlongABareCorridor) {
  const OccupancyGrid world = test::long_corridor();
  OdometerDrive drive{world, {15.0, 1.0, 0.0}};
  for (int i = 0; i < 100; ++i) {
    const LaserMotion seen = drive.step(kForward);
    EXPECT_EQ(seen.stood_m, 0.0) << i;
  }
  const Pose2 wrong = off({15.0, 1.0, 0.0}, drive.truth(), drive.odometer().start_from_robot());
  EXPECT_LT(wrong.position().norm(), 0.1);
  EXPECT_GT(drive.step(kForward).laser_covariance(0, 0), 1.0);
}

/// 40 m long and 2 m wide; both walls go back by a cell at a few doors.
OccupancyGrid corridor_with_doors() {
  std::vector<std::string> lines(26, std::string(400, '.'));
  for (const int row : {0, 1, 2, 23, 24, 25}) lines[static_cast<std::size_t>(row)] = std::string(400, '#');
  for (const int door : {40, 110, 150, 235, 330}) {
    for (const int row : {1, 2})
      lines[static_cast<std::size_t>(row)].replace(static_cast<std::size_t>(door), 9, std::string(9, '.'));
    lines[23].replace(static_cast<std::size_t>(door + 40), 9, std::string(9, '.'));
  }
  return test::drawn_grid(lines, 0.1);
}

TEST(LaserOdometer, AddsUpTheLittleThatScansOfACorridorTellOfARobotThatStands) {
  const OccupancyGrid world = corridor_with_doors();
  for (const double start_x : {10.0, 13.0, 20.0}) {
    const Pose2 start{start_x, 1.3, 0.0};
    OdometerDrive drive{world, start};
    for (int i = 0; i < 20; ++i) EXPECT_EQ(drive.step(kForward).stood_m, 0.0) << "drives";
    const Pose2 stands = drive.truth();
    for (int i = 0; i < 75; ++i) (void)drive.step({}, kForward);
    EXPECT_LT(distance_between(drive.truth(), stands), 1e-9);
    EXPECT_LT(off(start, stands, drive.odom_from_robot()).position().norm(), 0.2) << start_x << ": 6 m by the wheels";
    for (int i = 0; i < 20; ++i) (void)drive.step(kForward);
    EXPECT_EQ(drive.step(kForward).stood_m, 0.0) << "drives on";
    EXPECT_LT(off(start, drive.truth(), drive.odom_from_robot()).position().norm(), 0.3) << start_x;
  }
}

TEST(LaserOdometer, GoesOnWhereTheOdometryBeginsAnew) {
  const OccupancyGrid world = test::room_with_pillar();
  OdometerDrive drive{world, kInRoom};
  for (int i = 0; i < 15; ++i) (void)drive.step(kForward);
  drive.begin_epoch({50.0, -20.0, 2.0});
  for (int i = 0; i < 15; ++i) EXPECT_FALSE(drive.step(kForward).contradicts) << i;
  EXPECT_LT(off(kInRoom, drive.truth(), drive.odometer().start_from_robot()).position().norm(), 0.12);
}

TEST(LaserOdometer, IsLostAndGoesWithTheWheelsWhereNothingIsSeen) {
  const OccupancyGrid world = test::drawn_grid(std::vector<std::string>(40, std::string(400, '.')), 0.1);
  OdometerDrive drive{world, {5.0, 2.0, 0.0}};
  for (int i = 0; i < 20; ++i) (void)drive.step(kForward);
  EXPECT_TRUE(drive.step(kForward).is_lost);
  EXPECT_NEAR(drive.odometer().start_from_robot().x, 20 * kForward.x, 0.01);  // the first scan is the start
}

}  // namespace
}  // namespace deltamap::localization::odometer
