// SPDX-License-Identifier: Apache-2.0
#include "localization/pose_track.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace deltamap::localization {
namespace {

constexpr double kLeastSpreadM = 0.01;  // of the particles, when the track is held against them
constexpr double kLeastSpreadRad = 0.003;
constexpr double kMargin = 1.5;      // of the particles' noise over what the wheels have shown
constexpr double kLeastNoise = 0.2;  // as a share of what was set

/// Squared deviations between a pose and the particles.
double disagreement(const Pose2& pose, const Hypothesis& particles) {
  const Eigen::Vector3d off = difference(particles.map_from_robot, pose);
  const Eigen::Vector3d least{kLeastSpreadM * kLeastSpreadM, kLeastSpreadM * kLeastSpreadM,
                              kLeastSpreadRad * kLeastSpreadRad};
  const Eigen::Matrix3d spread = particles.covariance + least.asDiagonal().toDenseMatrix();
  return off.dot(spread.inverse() * off);
}

}  // namespace

void PoseTrack::forget() {
  last_.reset();
  wheels_.forget_stretch();
}

PoseTrack::Step PoseTrack::step_to(const ScanInstant& now) const {
  const ScanInstant& before = last_->instant;
  const double passed_s = std::max(0.0, seconds(now.time - before.time));
  if (!now.odometry || !before.odometry) return {{}, passed_s};
  const bool jumped = now.odometry->epoch != before.odometry->epoch;
  return {motion_between(before.odometry->joined_from_robot, now.odometry->joined_from_robot),
          jumped ? passed_s : std::min(now.odometry->uncovered_s, passed_s)};
}

RefinedPose PoseTrack::expected_at(const ScanInstant& now) const {
  const Step step = step_to(now);
  RefinedPose expected = carried(last_->believed, step.motion, wheels_);
  const double unknown_m = motion_.unknown_speed_m_per_s * step.unknown_s;
  const double unknown_rad = motion_.unknown_turn_rate_rad_per_s * step.unknown_s;
  expected.covariance.diagonal() +=
      Eigen::Vector3d{unknown_m * unknown_m, unknown_m * unknown_m, unknown_rad * unknown_rad};
  return expected;
}

void PoseTrack::carry(const ScanInstant& now) {
  if (!last_) return;
  last_ = Last{now, expected_at(now)};
  wheels_.forget_stretch();
}

RefinedPose PoseTrack::before_scan(const ScanInstant& now, const Hypothesis& particles) {
  if (!last_) return {particles.map_from_robot, particles.covariance};
  RefinedPose expected = expected_at(now);
  if (disagreement(expected.map_from_robot, particles) <= params_.agreement * params_.agreement) return expected;
  wheels_.forget_stretch();
  return {particles.map_from_robot, particles.covariance};
}

std::optional<Pose2> PoseTrack::carried_to(const ScanInstant& now) const {
  if (!last_) return std::nullopt;
  return last_->believed.map_from_robot * step_to(now).motion;
}

void PoseTrack::after_scan(const ScanInstant& now, const RefinedPose& believed) {
  if (last_) wheels_.learn(step_to(now).motion, believed);
  last_ = Last{now, believed};
}

MotionModelParams PoseTrack::particle_motion() const {
  const double distance = std::clamp(kMargin * wheels_.distance_scale(), kLeastNoise, 1.0);
  const double turn = std::clamp(kMargin * wheels_.turn_scale(), kLeastNoise, 1.0);
  MotionModelParams scaled = motion_;
  scaled.metre_per_metre *= distance;
  scaled.metre_per_turn_m *= distance;
  scaled.position_floor_m *= distance;
  scaled.turn_per_turn *= turn;
  scaled.turn_per_metre_rad *= turn;
  scaled.heading_floor_rad *= turn;
  return scaled;
}

}  // namespace deltamap::localization
