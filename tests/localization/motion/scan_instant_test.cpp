// SPDX-License-Identifier: Apache-2.0
#include "localization/motion/scan_instant.hpp"

#include <gtest/gtest.h>

namespace deltamap::localization::motion {
namespace {

constexpr double kUsualS = 1.0;
constexpr double kSameTime = 1e-9;

/// The counts begin anew with each epoch; the continuous frame goes on.
ScanInstant scan_at(double time_s, double driven_m, std::uint32_t epoch = 0) {
  const double counted_m = epoch == 0 ? driven_m : 0.0;
  return {timestamp_from_ns(0) + duration_from_seconds(time_s),
          OdometryAt{{counted_m, 0.0, 0.0}, epoch, {driven_m, 0.0, 0.0}}};
}

ScanInstant uncovered(ScanInstant scan, double seconds) {
  scan.odometry->uncovered_s = seconds;
  return scan;
}

ScanInstant without_wheels(double time_s) {
  return {timestamp_from_ns(0) + duration_from_seconds(time_s), std::nullopt};
}

TEST(MotionSince, IsWhatTheWheelsSayBetweenTwoScans) {
  const MotionSince since = motion_since(scan_at(1.0, 2.0), scan_at(3.0, 2.5), kUsualS);
  EXPECT_NEAR(since.motion.x, 0.5, 1e-12);
  EXPECT_NEAR(since.passed_s, 2.0, kSameTime);
  EXPECT_EQ(since.unknown_s, 0.0);
}

TEST(MotionSince, IsUnknownForAllTheTimeWithoutWheels) {
  EXPECT_NEAR(motion_since(scan_at(1.0, 2.0), without_wheels(1.7), kUsualS).unknown_s, 0.7, kSameTime);
  EXPECT_NEAR(motion_since(without_wheels(1.0), scan_at(1.7, 2.0), kUsualS).unknown_s, 0.7, kSameTime);
  EXPECT_EQ(motion_since(without_wheels(1.0), scan_at(1.7, 2.0), kUsualS).motion, Pose2{});
}

TEST(MotionSince, IsUnknownForNoMoreThanHasPassed) {
  EXPECT_NEAR(motion_since(scan_at(1.0, 0.0), uncovered(scan_at(1.5, 0.1), 0.2), kUsualS).unknown_s, 0.2, kSameTime);
  EXPECT_NEAR(motion_since(scan_at(1.0, 0.0), uncovered(scan_at(1.5, 0.1), 9.0), kUsualS).unknown_s, 0.5, kSameTime);
}

TEST(MotionSince, CountsAChangeOfEpochAsAMomentAndASilenceWithOneAsThreeSecondsAtMost) {
  EXPECT_NEAR(motion_since(scan_at(1.0, 0.0), scan_at(1.5, 0.0, 1), kUsualS).unknown_s, 0.3, kSameTime);
  EXPECT_NEAR(motion_since(scan_at(1.0, 0.0), scan_at(3.5, 0.0, 1), kUsualS).unknown_s, 2.5, kSameTime);
  EXPECT_NEAR(motion_since(scan_at(1.0, 0.0), scan_at(60.0, 0.0, 1), kUsualS).unknown_s, 3.0, kSameTime);
}

TEST(MotionSince, TakesNoTimeWhereTheClockHasFallenBack) {
  EXPECT_EQ(motion_since(scan_at(5.0, 0.0), scan_at(1.0, 0.0), kUsualS).passed_s, 0.0);
  EXPECT_EQ(motion_since(scan_at(5.0, 0.0), without_wheels(1.0), kUsualS).unknown_s, 0.0);
}

TEST(MotionSince, IsByScansWhereTheyHaveToldAllOfIt) {
  ScanInstant now = scan_at(3.0, 2.5);
  EXPECT_FALSE(motion_since(scan_at(1.0, 2.0), now, kUsualS).by_scans);
  now.odometry->led_since = scan_at(2.0, 0.0).time;
  EXPECT_FALSE(motion_since(scan_at(1.0, 2.0), now, kUsualS).by_scans);
  EXPECT_TRUE(motion_since(scan_at(2.0, 2.0), now, kUsualS).by_scans);
  EXPECT_TRUE(step_between(scan_at(2.0, 2.0), now).by_scans);
}

TEST(StepBetween, IsUnknownForAllTheTimeWhereTheEpochHasChanged) {
  const MotionSince step = step_between(scan_at(1.0, 2.0), scan_at(9.0, 2.0, 1));
  EXPECT_NEAR(step.unknown_s, 8.0, kSameTime);
  EXPECT_EQ(step_between(scan_at(1.0, 2.0), scan_at(9.0, 2.5)).unknown_s, 0.0);
  EXPECT_NEAR(step_between(scan_at(1.0, 2.0), scan_at(9.0, 2.5)).motion.x, 0.5, 1e-12);
  EXPECT_NEAR(step_between(scan_at(1.0, 2.0), without_wheels(9.0)).unknown_s, 8.0, kSameTime);
}

TEST(CountedBetween, HoldsTheWheelsErrorsWithinAnEpochAlone) {
  ScanInstant before = scan_at(1.0, 2.0);
  ScanInstant after = scan_at(2.0, 3.0);
  after.odometry->odom_from_robot.x = 3.1;
  EXPECT_NEAR(counted_between(before, after).x, 1.1, 1e-12);
  after.odometry->epoch = 1;
  EXPECT_NEAR(counted_between(before, after).x, 1.0, 1e-12);
  EXPECT_EQ(counted_between(before, without_wheels(2.0)), Pose2{});
}

}  // namespace
}  // namespace deltamap::localization::motion
