// SPDX-License-Identifier: Apache-2.0
// The motion from a keyframe to the newest scan, and how unsure it is: the errors of both poses by the odometry's
// filter, without what they have in common. Where scans know the way both are small; along a corridor what the wheels
// leave open is all that grows between them (Roumeliotis and Burdick, "Stochastic cloning", 2002).
#pragma once

#include "surveying/slam/drive_odometry.hpp"

namespace deltamap::surveying::slam {

class KeyframeMotion {
 public:
  /// From this scan on.
  void begin(const MovedScan& keyframe);
  void go_on(const MovedScan& moved);

  [[nodiscard]] const Pose2& keyframe_from_robot() const { return keyframe_from_robot_; }
  /// Of (x, y, θ) in the keyframe's frame; positive definite.
  [[nodiscard]] PoseCovariance covariance() const;

 private:
  Pose2 odom_from_keyframe_;
  Pose2 keyframe_from_robot_;
  PoseCovariance at_keyframe_ = PoseCovariance::Zero();  // errors, each in its robot's frame
  PoseCovariance now_ = PoseCovariance::Zero();
  Eigen::Matrix3d common_ = Eigen::Matrix3d::Zero();  // of now and the keyframe
  PoseCovariance torn_off_ = PoseCovariance::Zero();
};

}  // namespace deltamap::surveying::slam
