// SPDX-License-Identifier: Apache-2.0
#include "localization/tracking/odometry_noise.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/pose_spread.hpp"
#include "localization/motion/motion_model.hpp"

namespace deltamap::localization::tracking {
namespace {

constexpr double kLeastScale2 = 0.002;  // wheels are never quite right
constexpr double kMostScale2 = 9.0;
constexpr double kMostNormalizedInnovation =
    9.0;                                 // squared deviations: a slip is no measure of how the wheels usually do
constexpr double kLeastSharpness = 0.5;  // of a comparison: below it the scans say too little

/// What a squared difference says about the scale of the variance that should explain it.
double learned(double scale2, double difference2, double wheels_variance, double start_variance, double end_variance,
               double share) {
  const double gained = start_variance + scale2 * wheels_variance - end_variance;
  if (gained < kLeastSharpness * (start_variance + scale2 * wheels_variance)) return scale2;
  const double surprise = std::min(difference2 / gained, kMostNormalizedInnovation);
  return std::clamp(scale2 * (1.0 + share * (surprise - 1.0)), kLeastScale2, kMostScale2);
}

double variance_along(const PoseCovariance& covariance, const Eigen::Vector2d& direction) {
  return direction.dot(covariance.topLeftCorner<2, 2>() * direction);
}

}  // namespace

double OdometryNoiseEstimator::distance_scale() const { return std::sqrt(distance_scale2_); }
double OdometryNoiseEstimator::turn_scale() const { return std::sqrt(turn_scale2_); }

PoseCovariance OdometryNoiseEstimator::added(const Pose2& motion, double heading_rad) const {
  const double way_m = motion.position().norm();
  const double turn_rad = std::abs(motion.theta);
  const double along_m2 = distance_scale2_ * params_.metre_per_root_metre * params_.metre_per_root_metre * way_m;
  const double turn_rad2 = turn_scale2_ * (params_.turn_per_root_metre_rad * params_.turn_per_root_metre_rad * way_m +
                                           params_.turn_per_root_turn_rad * params_.turn_per_root_turn_rad * turn_rad);
  const double aside_m2 = 0.25 * along_m2 + turn_rad2 * way_m * way_m / 3.0;
  const double direction_rad = heading_rad + (way_m > 0.0 ? std::atan2(motion.y, motion.x) : 0.0);
  return motion::covariance_along(direction_rad, along_m2, aside_m2, turn_rad2);
}

void OdometryNoiseEstimator::learn(const Pose2& motion, const sensor::RefinedPose& believed) {
  if (params_.learning_share <= 0.0) return;
  if (!stretch_.begun) {
    begin_stretch(believed);
    return;
  }
  const double way_m = motion.position().norm();
  const double turn_rad = std::abs(motion.theta);
  stretch_.start_from_robot = stretch_.start_from_robot * motion;
  stretch_.way_m += way_m;
  stretch_.turn_rad += turn_rad;
  stretch_.distance_variance_m2 += params_.metre_per_root_metre * params_.metre_per_root_metre * way_m;
  stretch_.turn_variance_rad2 += params_.turn_per_root_metre_rad * params_.turn_per_root_metre_rad * way_m +
                                 params_.turn_per_root_turn_rad * params_.turn_per_root_turn_rad * turn_rad;
  if (stretch_.way_m < params_.stretch_m && stretch_.turn_rad < params_.stretch_rad) return;
  compare(believed);
  begin_stretch(believed);
}

void OdometryNoiseEstimator::begin_stretch(const sensor::RefinedPose& at) {
  stretch_ = {};
  stretch_.begun = true;
  stretch_.start = at;
}

void OdometryNoiseEstimator::compare(const sensor::RefinedPose& believed) {
  const sensor::RefinedPose& start = stretch_.start;
  const Pose2 by_wheels = start.map_from_robot * stretch_.start_from_robot;
  const double turn_rad = turn_between(by_wheels.theta, believed.map_from_robot.theta);
  turn_scale2_ = learned(turn_scale2_, turn_rad * turn_rad, stretch_.turn_variance_rad2, start.covariance(2, 2),
                         believed.covariance(2, 2), params_.learning_share);
  const Eigen::Vector2d driven = believed.map_from_robot.position() - start.map_from_robot.position();
  const double driven_m = driven.norm();
  if (driven_m < 0.8 * stretch_.way_m || stretch_.way_m < 0.8 * params_.stretch_m) return;  // not straight
  const double longer_m = driven_m - stretch_.start_from_robot.position().norm();
  const Eigen::Vector2d along = driven / driven_m;
  distance_scale2_ = learned(distance_scale2_, longer_m * longer_m, stretch_.distance_variance_m2,
                             variance_along(start.covariance, along), variance_along(believed.covariance, along),
                             params_.learning_share);
}

sensor::RefinedPose predicted(const sensor::RefinedPose& believed, const Pose2& motion,
                              const OdometryNoiseEstimator& wheels) {
  const Pose2 pose = believed.map_from_robot * motion;
  return {pose, carried(believed.covariance, believed.map_from_robot, pose) +
                    wheels.added(motion, believed.map_from_robot.theta)};
}

}  // namespace deltamap::localization::tracking
