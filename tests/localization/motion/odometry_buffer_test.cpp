// SPDX-License-Identifier: Apache-2.0
#include "localization/motion/odometry_buffer.hpp"

#include <gtest/gtest.h>

namespace deltamap::localization::motion {
namespace {

constexpr double kSame = 1e-9;

Timestamp at_s(double time_s) { return timestamp_from_ns(1'000'000'000'000) + duration_from_seconds(time_s); }

Odometry report(double time_s, const Pose2& pose, std::uint32_t epoch = 0) {
  Odometry odometry;
  odometry.time = at_s(time_s);
  odometry.odom_from_robot = pose;
  odometry.epoch = epoch;
  return odometry;
}

TEST(OdometryBuffer, KnowsNothingBeforeTheFirstReport) {
  const OdometryBuffer buffer{{}};
  EXPECT_FALSE(buffer.at(at_s(0.0)));
  EXPECT_EQ(buffer.velocity_at(at_s(0.0)).speed_m_per_s, 0.0);
}

TEST(OdometryBuffer, InterpolatesBetweenReportsTheShortWayRound) {
  OdometryBuffer buffer{{}};
  buffer.add(report(0.0, {0.0, 0.0, 3.1}));
  buffer.add(report(0.1, {0.2, 0.4, -3.1}));
  const auto middle = buffer.at(at_s(0.05));
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->odom_from_robot.x, 0.1, kSame);
  EXPECT_NEAR(middle->odom_from_robot.y, 0.2, kSame);
  EXPECT_NEAR(std::abs(middle->odom_from_robot.theta), std::numbers::pi, 1e-6);
  EXPECT_EQ(middle->uncovered_s, 0.0);
}

TEST(OdometryBuffer, ExtrapolatesAtMostSoFarAndSaysWhatIsNotCovered) {
  OdometryBuffer buffer{{.extrapolation_s = 0.15}};
  buffer.add(report(0.0, {0.0, 0.0, 0.0}));
  buffer.add(report(0.1, {0.05, 0.0, 0.0}));
  EXPECT_NEAR(buffer.at(at_s(0.2))->odom_from_robot.x, 0.10, kSame);
  EXPECT_NEAR(buffer.at(at_s(0.2))->uncovered_s, 0.0, kSame);
  EXPECT_NEAR(buffer.at(at_s(5.1))->odom_from_robot.x, 0.05 + 0.5 * 0.15, kSame);
  EXPECT_NEAR(buffer.at(at_s(5.1))->uncovered_s, 5.0 - 0.15, kSame);
}

TEST(OdometryBuffer, GoesOnFromWhereScansHaveCorrectedIt) {
  OdometryBuffer buffer{{}};
  for (int i = 0; i <= 10; ++i) buffer.add(report(0.1 * i, {0.1 * i, 0.0, 0.0}));
  buffer.correct(at_s(1.0), {-0.2, 0.0, 1.0}, {0.01, 0.001});
  EXPECT_NEAR(buffer.at(at_s(1.0))->continuous_odom_from_robot.x, 0.8, kSame);
  EXPECT_NEAR(buffer.at(at_s(1.0))->odom_from_robot.theta, 1.0, kSame);
  buffer.add(report(1.1, {1.1, 0.0, 0.0}));  // another decimetre ahead, in the direction that it has now
  const auto after = buffer.at(at_s(1.1));
  EXPECT_NEAR(after->continuous_odom_from_robot.x, 0.8 + 0.1 * std::cos(1.0), kSame);
  EXPECT_NEAR(after->odom_from_robot.y, 0.1 * std::sin(1.0), kSame);
  EXPECT_NEAR(after->slipped.position_m2, 0.01, kSame);
  EXPECT_NEAR(buffer.at(at_s(0.5))->slipped.position_m2, 0.0, kSame);
}

TEST(OdometryBuffer, KnowsSinceWhenScansHaveToldTheMotion) {
  OdometryBuffer buffer{{}};
  for (int i = 0; i <= 30; ++i) buffer.add(report(0.1 * i, {0.1 * i, 0.0, 0.0}));
  EXPECT_FALSE(buffer.at(at_s(1.0))->led_since);
  buffer.led_by_scans(at_s(1.0), at_s(1.2));
  buffer.led_by_scans(at_s(1.2), at_s(1.4));
  EXPECT_EQ(buffer.at(at_s(1.4))->led_since, at_s(1.0));
  EXPECT_FALSE(buffer.at(at_s(1.5))->led_since) << "no scan has told of it";
  buffer.led_by_scans(at_s(2.0), at_s(2.2));  // not from 1.4 to 2.0 s
  EXPECT_EQ(buffer.at(at_s(2.2))->led_since, at_s(2.0));
}

TEST(OdometryBuffer, ReadsLaggingStampsLater) {
  OdometryBuffer buffer{{}};
  for (int i = 0; i <= 10; ++i) buffer.add(report(0.1 * i, {0.01 * i * i, 0.0, 0.0}));
  buffer.set_lag(0.2);
  EXPECT_NEAR(buffer.at(at_s(0.3))->continuous_odom_from_robot.x, 0.25, kSame);
  buffer.set_lag(-0.1);
  EXPECT_NEAR(buffer.at(at_s(0.3))->continuous_odom_from_robot.x, 0.04, kSame);
}

TEST(OdometryBuffer, TellsTurnsOnlyWithinItsReportsAndOneEpoch) {
  OdometryBuffer buffer{{}};
  for (int i = 0; i <= 10; ++i) buffer.add(report(0.1 * i, {0.0, 0.0, 0.2 * i}, i > 5 ? 1 : 0));
  EXPECT_NEAR(*buffer.turned_between(at_s(0.05), at_s(0.35)), 0.6, kSame);
  EXPECT_FALSE(buffer.turned_between(at_s(0.3), at_s(0.9)));
  EXPECT_FALSE(buffer.turned_between(at_s(0.55), at_s(0.8)));
  EXPECT_FALSE(buffer.turned_between(at_s(0.8), at_s(1.1)));
}

TEST(OdometryBuffer, TrustsTheReportedSpeedWhereOnlyOneReportIsThere) {
  OdometryBuffer buffer{{}};
  Odometry only = report(0.0, {});
  only.speed_m_per_s = 0.4;
  buffer.add(only);
  EXPECT_NEAR(buffer.at(at_s(0.1))->odom_from_robot.x, 0.04, kSame);
}

TEST(OdometryBuffer, HoldsTheOldestReportForTimesBeforeIt) {
  OdometryBuffer buffer{{}};
  buffer.add(report(1.0, {2.0, 0.0, 0.0}));
  EXPECT_NEAR(buffer.at(at_s(0.4))->odom_from_robot.x, 2.0, kSame);
  EXPECT_NEAR(buffer.at(at_s(0.4))->uncovered_s, 0.6, kSame);
}

TEST(OdometryBuffer, NeverIntegratesAcrossEpochs) {
  OdometryBuffer buffer{{}};
  buffer.add(report(0.0, {1.0, 0.0, 0.0}));
  buffer.add(report(0.1, {1.1, 0.0, 0.0}));
  buffer.add(report(0.2, {50.0, -7.0, 1.0}, 1));
  buffer.add(report(0.3, Pose2{50.0, -7.0, 1.0} * Pose2{0.1, 0.0, 0.0}, 1));
  const auto before = buffer.at(at_s(0.0));
  const auto after = buffer.at(at_s(0.3));
  EXPECT_EQ(before->epoch, 0u);
  EXPECT_EQ(after->epoch, 1u);
  const Pose2 motion = motion_between(before->continuous_odom_from_robot, after->continuous_odom_from_robot);
  EXPECT_NEAR(motion.x, 0.2, kSame);
  EXPECT_NEAR(motion.y, 0.0, kSame);
  EXPECT_NEAR(after->odom_from_robot.x, 50.0 + 0.1 * std::cos(1.0), kSame);
  EXPECT_EQ(buffer.at(at_s(0.12))->epoch, 0u);
  EXPECT_EQ(buffer.at(at_s(0.18))->epoch, 1u);
}

TEST(OdometryBuffer, TakesOutWhatIsKnownOfTheWheelsFromTheNextReportOn) {
  OdometryBuffer buffer{{}};
  buffer.add(report(0.0, {1.0, 0.0, 0.0}));
  buffer.add(report(0.1, {1.1, 0.0, 0.0}));
  buffer.calibrate({.distance = 0.02, .turn = -0.05});
  const Pose2 before = buffer.at(at_s(0.1))->continuous_odom_from_robot;
  EXPECT_NEAR(before.x, 1.1, kSame) << "what was told before stays";
  buffer.add(report(0.2, {1.2, 0.0, 0.2}));
  const OdometryAt after = *buffer.at(at_s(0.2));
  EXPECT_NEAR(after.odom_from_robot.x, 1.2, kSame) << "as counted";
  const Pose2 motion = motion_between(before, after.continuous_odom_from_robot);
  EXPECT_NEAR(motion.position().norm(), 0.102, kSame);
  EXPECT_NEAR(motion.theta, 0.19, kSame);
}

TEST(OdometryBuffer, AddsWhatWasDrivenSinceReportsThatAreStampedLate) {
  OdometryBuffer buffer{{}};
  for (int i = 0; i < 20; ++i) buffer.add(report(0.1 * i, {0.05 * i, 0.0, 0.0}));
  const double told_m = buffer.at(at_s(1.5))->continuous_odom_from_robot.x;
  buffer.calibrate({.lag_s = 0.08});
  EXPECT_NEAR(buffer.at(at_s(1.5))->continuous_odom_from_robot.x - told_m, 0.5 * 0.08, 1e-6);
}

TEST(OdometryBuffer, LeavesOutReportsThatComeOutOfOrder) {
  OdometryBuffer buffer{{}};
  buffer.add(report(1.0, {1.0, 0.0, 0.0}));
  buffer.add(report(0.9, {9.0, 0.0, 0.0}));
  buffer.add(report(1.0, {9.0, 0.0, 0.0}));
  EXPECT_NEAR(buffer.at(at_s(1.0))->odom_from_robot.x, 1.0, kSame);
  EXPECT_NEAR(buffer.at(at_s(0.9))->odom_from_robot.x, 1.0, kSame);
}

TEST(OdometryBuffer, StartsAgainWhereTheClockFellBack) {
  OdometryBuffer buffer{{}};
  buffer.add(report(100.0, {1.0, 0.0, 0.0}));
  buffer.add(report(10.0, {5.0, 0.0, 0.0}));
  buffer.add(report(10.1, {5.1, 0.0, 0.0}));
  EXPECT_NEAR(buffer.at(at_s(10.1))->odom_from_robot.x, 5.1, kSame);
  EXPECT_NEAR(buffer.at(at_s(10.1))->continuous_odom_from_robot.x, 5.1, kSame) << "the wheels have counted on";
}

TEST(OdometryBuffer, KnowsNothingFromAScanThatFellBackUntilTheNextReportWhichGoesOn) {
  OdometryBuffer buffer{{}};
  buffer.add(report(100.0, {1.0, 0.0, 0.0}));
  buffer.clock_fell_back(at_s(100.05));
  EXPECT_FALSE(buffer.at(at_s(99.5)));
  buffer.add(report(99.6, {1.3, 0.0, 0.0}));
  EXPECT_NEAR(buffer.at(at_s(99.6))->continuous_odom_from_robot.x, 1.3, kSame);
}

TEST(OdometryBuffer, LeavesOutWhatIsNoNumber) {
  OdometryBuffer buffer{{}};
  buffer.add(report(1.0, {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}));
  EXPECT_FALSE(buffer.at(at_s(1.0)));
}

TEST(OdometryBuffer, ForgetsTheOldestWhenItIsFull) {
  OdometryBuffer buffer{{.capacity = 4}};
  for (int i = 0; i < 10; ++i) buffer.add(report(0.1 * i, {0.1 * i, 0.0, 0.0}));
  EXPECT_NEAR(buffer.at(at_s(0.0))->odom_from_robot.x, 0.6, kSame);
  EXPECT_NEAR(buffer.at(at_s(0.75))->odom_from_robot.x, 0.75, kSame);
}

TEST(OdometryBuffer, ClampsTheVelocityToWhatTheRobotCanDo) {
  OdometryBuffer buffer{{.max_speed_m_per_s = 1.5, .max_turn_rate_rad_per_s = 2.0}};
  for (int i = 0; i < 4; ++i) buffer.add(report(0.1 * i, {1.0 * i, 0.0, 0.5 * i}));
  const BodyVelocity velocity = buffer.velocity_at(at_s(0.15));
  EXPECT_EQ(velocity.speed_m_per_s, 1.5);
  EXPECT_EQ(velocity.turn_rate_rad_per_s, 2.0);
}

TEST(OdometryBuffer, MeasuresASpeedBackwards) {
  OdometryBuffer buffer{{}};
  for (int i = 0; i < 4; ++i) buffer.add(report(0.1 * i, {-0.03 * i, 0.0, 0.0}));
  EXPECT_NEAR(buffer.velocity_at(at_s(0.15)).speed_m_per_s, -0.3, kSame);
  EXPECT_NEAR(buffer.velocity_at(at_s(0.32)).speed_m_per_s, -0.3, kSame);
}

}  // namespace
}  // namespace deltamap::localization::motion
