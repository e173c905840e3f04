// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/keyframe_motion.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "surveying/slam/relative_covariance.hpp"

namespace deltamap::surveying::slam {
namespace {

/// What a robot may do while nobody looks.
const PoseCovariance kAnywhereNear = Eigen::Vector3d{0.25, 0.25, 0.09}.asDiagonal();
const Eigen::Vector3d kLeastDeviation{0.002, 0.002, 0.0005};  // as much as a scan is bent itself

/// What an error of the pose before becomes in that after, each in its robot's frame.
Eigen::Matrix3d carrying(const Pose2& motion) {
  const double c = std::cos(motion.theta);
  const double s = std::sin(motion.theta);
  Eigen::Matrix3d carried;
  carried << c, s, s * motion.x - c * motion.y,  //
      -s, c, c * motion.x + s * motion.y,        //
      0.0, 0.0, 1.0;
  return carried;
}

PoseCovariance without_negative(const PoseCovariance& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes{0.5 * (covariance + covariance.transpose())};
  const Eigen::Vector3d values = axes.eigenvalues().cwiseMax(0.0);
  return axes.eigenvectors() * values.asDiagonal() * axes.eigenvectors().transpose();
}

}  // namespace

void KeyframeMotion::begin(const MovedScan& keyframe) {
  odom_from_keyframe_ = keyframe.tracked.odom_from_robot;
  keyframe_from_robot_ = {};
  at_keyframe_ = now_ = common_ = keyframe.deviation;
  torn_off_.setZero();
}

void KeyframeMotion::go_on(const MovedScan& moved) {
  keyframe_from_robot_ = motion_between(odom_from_keyframe_, moved.tracked.odom_from_robot);
  now_ = moved.deviation;
  common_ = moved.kept * common_;
  if (moved.is_torn_off) torn_off_ += kAnywhereNear;
}

PoseCovariance KeyframeMotion::covariance() const {
  const Eigen::Matrix3d carried = carrying(keyframe_from_robot_);
  const Eigen::Matrix3d common = common_ * carried.transpose();
  const PoseCovariance at_robot =
      now_ + carried * at_keyframe_ * carried.transpose() - common - common.transpose() + torn_off_;
  return turned_covariance(without_negative(at_robot), keyframe_from_robot_.theta) +
         PoseCovariance{kLeastDeviation.cwiseAbs2().asDiagonal()};
}

}  // namespace deltamap::surveying::slam
