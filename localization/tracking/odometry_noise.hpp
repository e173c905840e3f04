// SPDX-License-Identifier: Apache-2.0
// Estimates the noise of the odometry while the robot drives. Over each stretch between two poses that scans fix well,
// the motion that the wheels counted is compared with the motion between these poses. The variance learned in this way
// is what a prediction by the wheels adds to the covariance of a pose.
#pragma once

#include <Eigen/Core>

#include "core/geometry/angle.hpp"
#include "core/geometry/pose2.hpp"
#include "localization/sensor/pose_refinement.hpp"

namespace deltamap::localization::tracking {

/// The error of odometry as a random walk: its variance grows with the way and with the turn. What the wheels show
/// scales it.
struct OdometryNoiseParams {
  double metre_per_root_metre = 0.05;             ///< deviation of the distance after one metre, m; > 0
  double turn_per_root_metre_rad = radians(1.7);  ///< deviation of the heading after one metre, rad; > 0
  double turn_per_root_turn_rad = radians(2.0);   ///< deviation of the heading after one radian of turn, rad; > 0
  double learning_share = 0.1;                    ///< weight of one stretch in what was learned; 0 = never learn, < 1
  double stretch_m = 1.5;                         ///< way over which wheels and scans are compared, m; > 0
  double stretch_rad = radians(86.0);             ///< or turn, rad; > 0
};

class OdometryNoiseEstimator {
 public:
  explicit OdometryNoiseEstimator(const OdometryNoiseParams& params) : params_{params} {}

  /// The covariance that a motion of the wheels adds, in the map frame, for a robot that starts with this heading.
  [[nodiscard]] PoseCovariance added(const Pose2& motion, double heading_rad) const;

  /// One scan: what the wheels did since the last one, and where the scan put the robot.
  void learn(const Pose2& motion, const sensor::RefinedPose& believed);

  /// Compares nothing with what lay before: the pose was set, not driven.
  void forget_stretch() { stretch_ = {}; }

  /// Deviation of the distance and of the turn, as shares of what the parameters say.
  [[nodiscard]] double distance_scale() const;
  [[nodiscard]] double turn_scale() const;

 private:
  /// What the wheels said since a pose that is known.
  struct Stretch {
    bool begun = false;
    sensor::RefinedPose start;
    Pose2 start_from_robot;  ///< by the wheels
    double way_m = 0.0;
    double turn_rad = 0.0;
    double distance_variance_m2 = 0.0;
    double turn_variance_rad2 = 0.0;
  };
  void begin_stretch(const sensor::RefinedPose& at);
  void compare(const sensor::RefinedPose& believed);

  OdometryNoiseParams params_;
  Stretch stretch_;
  double distance_scale2_ = 1.0;
  double turn_scale2_ = 1.0;
};

/// The prediction of a pose along a motion of the wheels.
[[nodiscard]] sensor::RefinedPose predicted(const sensor::RefinedPose& believed, const Pose2& motion,
                                            const OdometryNoiseEstimator& wheels);

}  // namespace deltamap::localization::tracking
