// SPDX-License-Identifier: Apache-2.0
// Scans of a drawn grid as a standing robot would take them: 181 beams over half a turn, laser at the robot's middle.
#pragma once

#include <cmath>

#include "core/grid/grid_ray.hpp"
#include "core/messages.hpp"
#include "core/random.hpp"

namespace deltamap::test {

/// What the robot sees from `map_from_robot`; the estimate is the same pose with the covariance given, odometry as
/// well.
inline TrackedScan seen_scan(const OccupancyGrid& world, const Pose2& map_from_robot, double range_deviation_m,
                             Random& random, double max_range_m = 20.0) {
  TrackedScan tracked;
  tracked.scan.first_bearing_rad = radians(-90.0);
  tracked.scan.bearing_step_rad = radians(1.0);
  tracked.scan.max_range_m = max_range_m;
  for (int i = 0; i <= 180; ++i) {
    const double bearing_rad = radians(i - 90.0);
    const double direction_rad = map_from_robot.theta + bearing_rad;
    const Point2 towards{std::cos(direction_rad), std::sin(direction_rad)};
    Beam beam{0.0F, 0.0F, BeamKind::kBeyondMaximum};
    RayInRobot ray;
    walk_ray(world.geometry(), map_from_robot.position(), map_from_robot.position() + max_range_m * towards,
             [&](Cell cell, double entered_m) {
               if (world.at(cell) != CellState::kOccupied) return true;
               const double range_m = entered_m + random.normal(range_deviation_m);
               beam = {static_cast<float>(range_m), 0.0F, BeamKind::kRange};
               ray.end = Eigen::Vector2f{static_cast<float>(range_m * std::cos(bearing_rad)),
                                         static_cast<float>(range_m * std::sin(bearing_rad))};
               return false;
             });
    tracked.scan.beams.push_back(beam);
    tracked.rays.push_back(ray);
  }
  tracked.estimate.map_from_robot = map_from_robot;
  tracked.estimate.state = LocalizerState::kTracking;
  tracked.odom_from_robot = map_from_robot;
  return tracked;
}

/// The pose with normal errors added.
inline Pose2 disturbed(const Pose2& pose, double position_deviation_m, double heading_deviation_rad, Random& random) {
  return {pose.x + random.normal(position_deviation_m), pose.y + random.normal(position_deviation_m),
          wrapped_angle(pose.theta + random.normal(heading_deviation_rad))};
}

}  // namespace deltamap::test
