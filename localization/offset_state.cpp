// SPDX-License-Identifier: Apache-2.0
#include "localization/offset_state.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace deltamap::localization {
namespace {

// Before anything was learned: deviations of distance, turn, drift (rad/m) and lag (s).
const Eigen::Vector4d kWheelDeviations{0.03, 0.03, 0.01, 0.05};
// Beyond these the wheels are broken, not biased.
const Eigen::Vector4d kLargestWheelErrors{0.1, 0.1, 0.15, 0.3};
// How fast they change: variances a metre. Tyres wear, loads shift.
const Eigen::Vector4d kWheelWalk{1e-7, 1e-7, 1e-8, 1e-8};
// A laser that was screwed on with a ruler: m, m, rad.
const Eigen::Vector3d kMountDeviations{0.015, 0.015, 0.005};
const Eigen::Vector3d kLargestMountErrors{0.1, 0.1, 0.05};
// Screws work loose: 2 mm and 0.05 degrees in 100 m.
const Eigen::Vector3d kMountWalk{4e-8, 4e-8, 8e-9};

Point2 turned_left(const Point2& p) { return {-p.y(), p.x()}; }

}  // namespace

OffsetState::OffsetState() : mean_{Eigen::VectorXd::Zero(kFixed)}, covariance_{Eigen::MatrixXd::Zero(kFixed, kFixed)} {
  covariance_.diagonal().segment<4>(kWheels) = kWheelDeviations.cwiseAbs2();
  covariance_.diagonal().segment<3>(kMount) = kMountDeviations.cwiseAbs2();
}

void OffsetState::start(const RefinedPose& at) {
  constexpr Eigen::Index kLearned = kFixed - kPose;
  OffsetState anew;
  if (is_sound()) {
    anew.mean_.tail<kLearned>() = mean_.segment<kLearned>(kPose);
    anew.covariance_.bottomRightCorner<kLearned, kLearned>() = covariance_.block<kLearned, kLearned>(kPose, kPose);
  }
  anew.mean_.head<kPose>() << at.map_from_robot.x, at.map_from_robot.y, at.map_from_robot.theta;
  anew.covariance_.topLeftCorner<kPose, kPose>() = at.covariance;
  *this = std::move(anew);
}

RefinedPose OffsetState::pose() const {
  return {{mean_[0], mean_[1], wrapped_angle(mean_[2])}, covariance_.topLeftCorner<kPose, kPose>()};
}

DriveCalibration OffsetState::calibration() const {
  const Eigen::Vector<double, kFixed> deviations = covariance_.diagonal().head<kFixed>().cwiseMax(0.0).cwiseSqrt();
  const auto wheels = [](const auto& of) {
    return WheelErrors{of[kWheels], of[kWheels + 1], of[kWheels + 2], of[kWheels + 3]};
  };
  const auto mount = [](const auto& of) { return Pose2{of[kMount], of[kMount + 1], of[kMount + 2]}; };
  return {wheels(mean_), wheels(deviations), mount(mean_), mount(deviations)};
}

Pose2 OffsetState::corrected(const WheelStep& step) const {
  const WheelErrors errors = calibration().wheels;
  const double further_rad = errors.turn * step.motion.theta + errors.drift_rad_per_m * step.motion.position().norm() +
                             errors.lag_s * step.turn_rate_change_rad_per_s;
  const Pose2 along_the_arc = Pose2{0.0, 0.0, 0.5 * further_rad} * step.motion;
  return {(1.0 + errors.distance) * along_the_arc.x + errors.lag_s * step.speed_change_m_per_s,
          (1.0 + errors.distance) * along_the_arc.y, step.motion.theta + further_rad};
}

void OffsetState::carry(const WheelStep& step, const PoseCovariance& added) {
  const Pose2 motion = corrected(step);
  const double length_m = step.motion.position().norm();
  const Pose2 turned{0.0, 0.0, mean_[2]};
  const Point2 moved = turned * motion.position();
  const Point2 by_half_turn = 0.5 * turned_left(moved);
  Eigen::Matrix<double, kPose, kFixed> by = Eigen::Matrix<double, kPose, kFixed>::Zero();
  by.leftCols<kPose>().setIdentity();
  by.block<2, 1>(0, 2) = turned_left(moved);
  by.col(kWheels).head<2>() = moved / (1.0 + mean_[kWheels]);
  by.col(kWheels + 1).head<2>() = by_half_turn * step.motion.theta;
  by.col(kWheels + 2).head<2>() = by_half_turn * length_m;
  by.col(kWheels + 3).head<2>() =
      by_half_turn * step.turn_rate_change_rad_per_s + turned * Point2{step.speed_change_m_per_s, 0.0};
  by.row(2).segment<4>(kWheels) << 0.0, step.motion.theta, length_m, step.turn_rate_change_rad_per_s;
  mean_.head<kPose>() += Eigen::Vector3d{moved.x(), moved.y(), motion.theta};
  mean_.segment<4>(kWheels) =
      mean_.segment<4>(kWheels).cwiseMax(-kLargestWheelErrors).cwiseMin(kLargestWheelErrors).eval();
  covariance_.topRows<kPose>() = (by * covariance_.topRows<kFixed>()).eval();
  covariance_.leftCols<kPose>() = (covariance_.leftCols<kFixed>() * by.transpose()).eval();
  covariance_.topLeftCorner<kPose, kPose>() += added;
  covariance_.diagonal().segment<4>(kWheels) += length_m * kWheelWalk;
  mean_.segment<3>(kMount) =
      mean_.segment<3>(kMount).cwiseMax(-kLargestMountErrors).cwiseMin(kLargestMountErrors).eval();
  covariance_.diagonal().segment<3>(kMount) += length_m * kMountWalk;
}

void OffsetState::jump(const Pose2& to, const PoseCovariance& slip) {
  mean_.head<kPose>() << to.x, to.y, to.theta;
  covariance_.topLeftCorner<kPose, kPose>() += slip;
}

void OffsetState::append(double offset_m, double deviation_m, double deviation_rad) {
  const Eigen::Index size = mean_.size();
  mean_.conservativeResize(size + 2);
  mean_.tail<2>() << offset_m, 0.0;
  covariance_.conservativeResize(size + 2, size + 2);
  covariance_.rightCols<2>().setZero();
  covariance_.bottomRows<2>().setZero();
  covariance_(size, size) = deviation_m * deviation_m;
  covariance_(size + 1, size + 1) = deviation_rad * deviation_rad;
}

void OffsetState::remove(std::size_t surface) {
  const Eigen::Index at = offset_of(surface);
  const Eigen::Index after = mean_.size() - at - 2;
  mean_.segment(at, after) = mean_.tail(after).eval();
  mean_.conservativeResize(at + after);
  covariance_.middleRows(at, after) = covariance_.bottomRows(after).eval();
  covariance_.middleCols(at, after) = covariance_.rightCols(after).eval();
  covariance_.conservativeResize(at + after, at + after);
}

void OffsetState::update(const SparseRow& row, double innovation, double variance) {
  column_ = Eigen::VectorXd::Zero(mean_.size());
  for (const SparseRow::Entry& entry : row.used()) column_ += entry.value * covariance_.col(entry.index);
  double expected = variance;
  for (const SparseRow::Entry& entry : row.used()) expected += entry.value * column_[entry.index];
  mean_ += column_ * (innovation / expected);
  covariance_.noalias() -= column_ * (column_.transpose() / expected);
}

}  // namespace deltamap::localization
