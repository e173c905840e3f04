// SPDX-License-Identifier: Apache-2.0
// Why one joint Gaussian: a surface that was followed while the pose was off has an error in common with it. Their
// correlation keeps that error from coming back as a new observation (as in SLAM with an extended Kalman filter).
#include "localization/surfaces/offset_state.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace deltamap::localization::surfaces {
namespace {

constexpr Eigen::Index kLearned = OffsetState::kFixed - OffsetState::kPose;
using Learned = Eigen::Vector<double, kLearned>;

/// Of the laser's mount (x and y, m; heading, rad) and of the wheels, in the order of the state.
Learned learned(const Eigen::Vector3d& mount, const Eigen::Vector4d& wheels) {
  Learned both;
  both << mount, wheels;
  return both;
}

// Before anything was learned: a laser that was screwed on with a ruler, wheels of which nothing is known.
const Learned kDeviations = learned({0.015, 0.015, 0.005}, {0.03, 0.03, 0.01, 0.05});
// Beyond these it is broken, not biased.
const Learned kLargestErrors = learned({0.1, 0.1, 0.05}, {0.1, 0.1, 0.15, 0.3});
// How fast they change: variances a metre. Screws work loose by 2 mm and 0.05 degrees in 100 m, tyres wear, loads
// shift.
const Learned kWalk = learned({4e-8, 4e-8, 8e-9}, {1e-7, 1e-7, 1e-8, 1e-8});

template <typename Values>
motion::WheelErrors wheels_in(const Values& state) {
  const auto wheels = state.template segment<4>(OffsetState::kWheels);
  return {wheels[0], wheels[1], wheels[2], wheels[3]};
}

template <typename Values>
Pose2 mount_in(const Values& state) {
  const auto mount = state.template segment<3>(OffsetState::kMount);
  return {mount[0], mount[1], mount[2]};
}

Point2 turned_left(const Point2& p) { return {-p.y(), p.x()}; }

}  // namespace

OffsetState::OffsetState() : mean_{Eigen::VectorXd::Zero(kFixed)}, covariance_{Eigen::MatrixXd::Zero(kFixed, kFixed)} {
  covariance_.diagonal().tail<kLearned>() = kDeviations.cwiseAbs2();
}

void OffsetState::restore(const motion::DriveCalibration& known) {
  constexpr double kAsOverM = 1000.0;
  const auto of = [](const Pose2& mount, const motion::WheelErrors& wheels) {
    return learned({mount.x, mount.y, mount.theta},
                   {wheels.distance, wheels.turn, wheels.drift_rad_per_m, wheels.lag_s});
  };
  const Learned deviations = of(known.mount_deviations, known.wheel_deviations);
  mean_.segment<kLearned>(kPose) =
      of(known.mount_error, known.wheels).cwiseMax(-kLargestErrors).cwiseMin(kLargestErrors);
  covariance_.middleRows<kLearned>(kPose).setZero();
  covariance_.middleCols<kLearned>(kPose).setZero();
  covariance_.diagonal().segment<kLearned>(kPose) =
      (deviations.cwiseAbs2() + kAsOverM * kWalk).cwiseMin(kDeviations.cwiseAbs2());
}

OffsetState OffsetState::without_surfaces() const {
  OffsetState alone;
  alone.mean_ = mean_.head<kFixed>();
  alone.covariance_ = covariance_.topLeftCorner<kFixed, kFixed>();
  return alone;
}

void OffsetState::start(const sensor::RefinedPose& at) {
  *this = is_sound() ? without_surfaces() : OffsetState{};
  mean_.head<kPose>() << at.map_from_robot.x, at.map_from_robot.y, at.map_from_robot.theta;
  covariance_.topRows<kPose>().setZero();
  covariance_.leftCols<kPose>().setZero();
  covariance_.topLeftCorner<kPose, kPose>() = at.covariance;
}

sensor::RefinedPose OffsetState::pose() const {
  return {{mean_[0], mean_[1], wrapped_angle(mean_[2])}, covariance_at<kPose>(0)};
}

motion::DriveCalibration OffsetState::calibration() const {
  const Eigen::Vector<double, kFixed> deviations = covariance_.diagonal().head<kFixed>().cwiseMax(0.0).cwiseSqrt();
  return {wheels_in(mean_), wheels_in(deviations), mount_in(mean_), mount_in(deviations)};
}

Pose2 OffsetState::corrected(const motion::WheelStep& step) const { return motion::corrected(step, wheels_in(mean_)); }

void OffsetState::predict(const motion::WheelStep& step, const PoseCovariance& added) {
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
  mean_.segment<kLearned>(kPose) =
      mean_.segment<kLearned>(kPose).cwiseMax(-kLargestErrors).cwiseMin(kLargestErrors).eval();
  const PoseCovariance of_pose = by * covariance_at<kFixed>(0) * by.transpose() + added;
  covariance_.leftCols<kPose>() = (columns<kFixed>(0) * by.transpose()).eval();
  covariance_.topLeftCorner<kPose, kPose>() = of_pose;
  covariance_.diagonal().segment<kLearned>(kPose) += length_m * kWalk;
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

bool OffsetState::update(const sensor::RefinedPose& seen) {
  Eigen::Matrix<double, kPose, kPosed> by = scan_by_pose_and_mount();
  by.middleCols<2>(kMount).setZero();  // a centre of rotation that is told wrong looks the same
  const Eigen::Vector3d innovation = difference(pose().map_from_robot, seen.map_from_robot);
  const Eigen::Matrix<double, Eigen::Dynamic, kPose> cross = columns<kPosed>(0) * by.transpose();
  const PoseCovariance inverse = (by * cross.topRows<kPosed>() + seen.covariance).inverse();
  if (innovation.dot(inverse * innovation) > kInnovationGate) return false;
  mean_ += cross * (inverse * innovation);
  subtract_product<kPose>(cross * inverse, cross);
  return true;
}

Eigen::Matrix<double, 3, 6> OffsetState::scan_by_pose_and_mount() const {
  Eigen::Matrix<double, kPose, kPosed> by;
  by << Eigen::Matrix3d::Identity(), Eigen::AngleAxisd{mean_[2], Eigen::Vector3d::UnitZ()}.toRotationMatrix();
  return by;
}

// With H the rows, R their variances and H P Hᵀ + R = L Lᵀ: P − W Wᵀ, where W = P Hᵀ L⁻ᵀ.
void OffsetState::update(std::span<const RowMeasurement> measurements) {
  const auto count = static_cast<Eigen::Index>(measurements.size());
  if (count == 0) return;
  Eigen::MatrixXd gain = Eigen::MatrixXd::Zero(mean_.size(), count);
  Eigen::MatrixXd expected{count, count};
  Eigen::VectorXd innovation{count};
  for (Eigen::Index i = 0; i < count; ++i) {
    const RowMeasurement& measured = measurements[static_cast<std::size_t>(i)];
    for (const auto& [index, value] : measured.row.used()) {
      gain.col(i).head(index) += value * covariance_.row(index).head(index).transpose();
      gain.col(i).tail(mean_.size() - index) += value * covariance_.col(index).tail(mean_.size() - index);
    }
    expected.row(i).setZero();
    for (const SparseRow::Entry& entry : measured.row.used())
      expected.row(i).head(i + 1) += entry.value * gain.row(entry.index).head(i + 1);
    expected(i, i) += measured.variance;
    innovation[i] = measured.innovation;
  }
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> root{expected};
  root.matrixL().solveInPlace(innovation);
  root.matrixU().solveInPlace<Eigen::OnTheRight>(gain);
  mean_ += gain * innovation;
  subtract_product<Eigen::Dynamic>(gain, gain);
}

}  // namespace deltamap::localization::surfaces
