// SPDX-License-Identifier: Apache-2.0
#include "localization/tracking/pose_filter.hpp"

#include <algorithm>

#include "core/geometry/pose_spread.hpp"

namespace deltamap::localization::tracking {
namespace {

constexpr double kAgreement = 3.0;      // deviations of the particles; beyond, they are right and the filter is wrong
constexpr double kLeastSpreadM = 0.01;  // of the particles, when the track is held against them
constexpr double kLeastSpreadRad = 0.003;
constexpr double kMargin = 1.5;      // of the particles' noise over what the wheels have shown
constexpr double kLeastNoise = 0.2;  // as a share of what was set

/// Squared deviations between a pose and the particles.
double disagreement(const Pose2& pose, const particles::ParticleCluster& particles) {
  const Eigen::Vector3d off = difference(particles.map_from_robot, pose);
  const Eigen::Vector3d least{kLeastSpreadM * kLeastSpreadM, kLeastSpreadM * kLeastSpreadM,
                              kLeastSpreadRad * kLeastSpreadRad};
  const Eigen::Matrix3d spread = particles.covariance + least.asDiagonal().toDenseMatrix();
  return squared_deviations(off, spread);
}

}  // namespace

void PoseFilter::forget() {
  last_.reset();
  odometry_noise_.forget_stretch();
}

sensor::RefinedPose PoseFilter::expected_at(const motion::ScanInstant& now) const {
  const motion::MotionSince step = motion::step_between(last_->instant, now);
  sensor::RefinedPose expected = predicted(last_->believed, step.motion, odometry_noise_);
  if (step.by_scans)
    expected.covariance = carried(last_->believed.covariance, last_->believed.map_from_robot, expected.map_from_robot);
  expected.covariance += motion::unknown_motion_covariance(motion_, step.unknown_s) + step.slipped.covariance();
  return expected;
}

void PoseFilter::predict(const motion::ScanInstant& now) {
  if (!last_) return;
  last_ = Last{now, expected_at(now)};
  odometry_noise_.forget_stretch();
}

sensor::RefinedPose PoseFilter::before_scan(const motion::ScanInstant& now,
                                            const particles::ParticleCluster& particles) {
  if (!last_) return {particles.map_from_robot, particles.covariance};
  sensor::RefinedPose expected = expected_at(now);
  if (disagreement(expected.map_from_robot, particles) <= kAgreement * kAgreement) return expected;
  odometry_noise_.forget_stretch();
  return {particles.map_from_robot, particles.covariance};
}

std::optional<Pose2> PoseFilter::predicted_at(const motion::ScanInstant& now) const {
  if (!last_) return std::nullopt;
  return last_->believed.map_from_robot * motion::step_between(last_->instant, now).motion;
}

void PoseFilter::after_scan(const motion::ScanInstant& now, const sensor::RefinedPose& believed) {
  if (last_) {
    const motion::MotionSince step = motion::step_between(last_->instant, now);
    // Where scans took the wheels' place they tell nothing of how wheels usually err.
    step.slipped.is_none() ? odometry_noise_.learn(step.motion, believed) : odometry_noise_.forget_stretch();
  }
  last_ = Last{now, believed};
}

motion::MotionModelParams PoseFilter::particle_motion() const {
  const double distance = std::clamp(kMargin * odometry_noise_.distance_scale(), kLeastNoise, 1.0);
  const double turn = std::clamp(kMargin * odometry_noise_.turn_scale(), kLeastNoise, 1.0);
  motion::MotionModelParams scaled = motion_;
  scaled.metre_per_metre *= distance;
  scaled.metre_per_turn_m *= distance;
  scaled.position_floor_m *= distance;
  scaled.turn_per_turn *= turn;
  scaled.turn_per_metre_rad *= turn;
  scaled.heading_floor_rad *= turn;
  return scaled;
}

}  // namespace deltamap::localization::tracking
