// SPDX-License-Identifier: Apache-2.0
#include "mapping/gate/pose_jump.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::mapping::gate {

bool PoseJump::observe(const TrackedScan& tracked) {
  const Estimate& estimate = tracked.estimate;
  const Timestamp time = tracked.scan.time;
  const bool follows = !samples_.empty() && tracked.odometry_epoch == epoch_ && time >= samples_.back().time;
  if (!follows) samples_.clear();
  epoch_ = tracked.odometry_epoch;

  const PoseCovariance covariance = estimate.noise_covariance();
  Sample now{.time = time,
             .map_from_robot = estimate.map_from_robot,
             .odom_from_robot = tracked.odom_from_robot,
             .position_deviation_m = std::sqrt(std::max(0.0, covariance(0, 0) + covariance(1, 1))),
             .heading_deviation_rad = std::sqrt(std::max(0.0, covariance(2, 2)))};
  if (!samples_.empty()) {
    const Sample& last = samples_.back();
    now.driven_m = last.driven_m + distance_between(last.odom_from_robot, now.odom_from_robot);
    now.turned_rad = last.turned_rad + std::abs(turn_between(last.odom_from_robot.theta, now.odom_from_robot.theta));
  }
  samples_.push_back(now);
  while (seconds(time - samples_.front().time) > params_.window_s) samples_.pop_front();

  const Sample& first = samples_.front();
  const Pose2 expected = first.map_from_robot * (inverse(first.odom_from_robot) * now.odom_from_robot);
  const double allowed_m = params_.least_m + params_.per_metre * (now.driven_m - first.driven_m) +
                           params_.deviations * std::hypot(first.position_deviation_m, now.position_deviation_m);
  const double allowed_rad = params_.least_rad + params_.rad_per_rad * (now.turned_rad - first.turned_rad) +
                             params_.deviations * std::hypot(first.heading_deviation_rad, now.heading_deviation_rad);
  const bool jumped = distance_between(expected, now.map_from_robot) > allowed_m ||
                      std::abs(turn_between(expected.theta, now.map_from_robot.theta)) > allowed_rad;
  if (jumped) samples_.assign(1, now);
  return jumped;
}

}  // namespace deltamap::mapping::gate
