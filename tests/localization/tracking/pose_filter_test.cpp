// SPDX-License-Identifier: Apache-2.0
#include "localization/tracking/pose_filter.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"

namespace deltamap::localization::tracking {
namespace {

constexpr double kExact = 1e-12;

PoseCovariance deviations(double position_m, double heading_rad) {
  return Eigen::Vector3d{position_m * position_m, position_m * position_m, heading_rad * heading_rad}.asDiagonal();
}

motion::ScanInstant instant(double time_s, const Pose2& odom_from_robot, std::uint32_t epoch = 0) {
  return {timestamp_from_ns(0) + duration_from_seconds(time_s),
          motion::OdometryAt{odom_from_robot, epoch, odom_from_robot}};
}

particles::ParticleCluster particles_at(const Pose2& map_from_robot, double position_deviation_m = 0.05) {
  return {map_from_robot, deviations(position_deviation_m, 0.02), 1.0};
}

const sensor::RefinedPose kSeen{{2.0, 3.0, 0.0}, deviations(0.01, 0.002)};
const motion::ScanInstant kAtScan = instant(0.0, {});
const motion::ScanInstant kAMetreOn = instant(1.0, {1.0, 0.0, 0.0});

/// A filter whose last scan, at kAtScan, saw the robot at kSeen.
PoseFilter corrected() {
  PoseFilter filter{{}, {}};
  filter.after_scan(kAtScan, kSeen);
  return filter;
}

TEST(PoseFilter, BeginsWithTheParticles) {
  PoseFilter filter{{}, {}};
  const particles::ParticleCluster particles = particles_at({7.0, 8.0, 1.0});
  EXPECT_FALSE(filter.predicted_at(kAtScan));
  const sensor::RefinedPose believed = filter.before_scan(kAtScan, particles);
  EXPECT_EQ(believed.map_from_robot.x, 7.0);
  EXPECT_EQ(believed.covariance, particles.covariance);
}

TEST(PoseFilter, GoesOnFromTheLastScanByTheWheels) {
  const sensor::RefinedPose believed = corrected().before_scan(kAMetreOn, particles_at({3.04, 3.0, 0.0}));
  EXPECT_NEAR(believed.map_from_robot.x, 3.0, kExact) << "not where the particles' mean lies";
  EXPECT_NEAR(believed.map_from_robot.y, 3.0, kExact);
  EXPECT_GT(believed.covariance(0, 0), kSeen.covariance(0, 0));
  EXPECT_LT(believed.covariance(0, 0), 0.1 * 0.1);
}

TEST(PoseFilter, YieldsToParticlesThatDisagreeByMoreThanTheirSpreadExplains) {
  const Pose2 off{3.3, 3.0, 0.0};
  EXPECT_EQ(corrected().before_scan(kAMetreOn, particles_at(off, 0.05)).map_from_robot.x, off.x);
  EXPECT_NEAR(corrected().before_scan(kAMetreOn, particles_at(off, 0.2)).map_from_robot.x, 3.0, kExact);
}

TEST(PoseFilter, ForgetsWhereTheRobotWas) {
  PoseFilter filter = corrected();
  filter.forget();
  EXPECT_FALSE(filter.predicted_at(kAMetreOn));
  EXPECT_EQ(filter.before_scan(kAMetreOn, particles_at({3.01, 3.0, 0.0})).map_from_robot.x, 3.01);
}

TEST(PoseFilter, PredictsOverManyStepsWhereNoScanCorrects) {
  PoseFilter filter = corrected();
  for (int i = 1; i <= 40; ++i) filter.predict(instant(0.1 * i, {0.1 * i, 0.0, 0.0}));
  const motion::ScanInstant now = instant(4.1, {4.1, 0.0, 0.0});
  ASSERT_TRUE(filter.predicted_at(now));
  EXPECT_NEAR(filter.predicted_at(now)->x, kSeen.map_from_robot.x + 4.1, 1e-9);
  const double after_four_m2 = filter.before_scan(now, particles_at({6.1, 3.0, 0.0}, 1.0)).covariance(0, 0);
  const double after_one_m2 = corrected().before_scan(kAMetreOn, particles_at({3.0, 3.0, 0.0})).covariance(0, 0);
  EXPECT_GT(after_four_m2, 3.0 * after_one_m2);
}

TEST(PoseFilter, IsAsUnsureAsTheTimeThatNoWheelsSpeakFor) {
  const motion::ScanInstant other_epoch = instant(2.0, {}, 1);
  const PoseCovariance added =
      corrected().before_scan(other_epoch, particles_at(kSeen.map_from_robot, 1.0)).covariance - kSeen.covariance;
  EXPECT_NEAR((added - motion::unknown_motion_covariance({}, 2.0)).norm(), 0.0, kExact);
  EXPECT_GT(added(0, 0), 0.0);
}

TEST(PoseFilter, GivesTheParticlesTheNoiseThatWasSetUntilTheWheelsHaveShownBetter) {
  const motion::MotionModelParams set;
  PoseFilter filter{{}, set};
  EXPECT_EQ(filter.particle_motion().metre_per_metre, set.metre_per_metre);
  EXPECT_EQ(filter.particle_motion().turn_per_metre_rad, set.turn_per_metre_rad);
  for (int i = 0; i < 2000; ++i) {
    const Pose2 at{0.05 * i, 0.0, 0.0};
    filter.after_scan(instant(0.1 * i, at), {at, deviations(0.001, 0.0003)});
  }
  const motion::MotionModelParams shown = filter.particle_motion();
  constexpr double kLeastShare = 0.2;
  EXPECT_NEAR(shown.metre_per_metre, kLeastShare * set.metre_per_metre, kExact);
  EXPECT_NEAR(shown.position_floor_m, kLeastShare * set.position_floor_m, kExact);
  EXPECT_NEAR(shown.turn_per_turn, kLeastShare * set.turn_per_turn, kExact);
  EXPECT_EQ(shown.slip_m, set.slip_m) << "good wheels slip as others do";
  EXPECT_EQ(shown.unknown_speed_m_per_s, set.unknown_speed_m_per_s);
}

TEST(PoseFilter, NeverGivesTheParticlesMoreNoiseThanWasSet) {
  const motion::MotionModelParams set;
  PoseFilter filter{{}, set};
  Random random{3};
  Pose2 odom;
  for (int i = 0; i < 2000; ++i) {
    odom = odom * Pose2{0.05 + random.normal(0.1), 0.0, random.normal(0.1)};
    filter.after_scan(instant(0.1 * i, odom), {{0.05 * i, 0.0, 0.0}, deviations(0.001, 0.0003)});
  }
  EXPECT_EQ(filter.particle_motion().metre_per_metre, set.metre_per_metre);
  EXPECT_EQ(filter.particle_motion().turn_per_turn, set.turn_per_turn);
}

}  // namespace
}  // namespace deltamap::localization::tracking
