// SPDX-License-Identifier: Apache-2.0
// Guesses of a place that are wrong by what a prior allows, for tests of the merges that have one.
#pragma once

#include "core/geometry/pose2.hpp"

namespace deltamap::surveying::grid_registration {

inline PoseCovariance covariance_of(double position_deviation_m, double heading_deviation_rad) {
  return Eigen::Vector3d{position_deviation_m * position_deviation_m, position_deviation_m * position_deviation_m,
                         heading_deviation_rad * heading_deviation_rad}
      .asDiagonal();
}

/// The guess is wrong by a turn about the robot and a shift.
inline Pose2 guess_from_map(const Point2& robot, double dx, double dy, double turn_rad) {
  return Pose2{robot.x() + dx, robot.y() + dy, turn_rad} * inverse(Pose2{robot.x(), robot.y(), 0.0});
}

}  // namespace deltamap::surveying::grid_registration
