// SPDX-License-Identifier: Apache-2.0
// How far a round robot gets on a straight line or an arc before it touches what a scan saw. What the laser could not
// see counts as an obstacle where it is wide enough to hide one.
#pragma once

#include <span>
#include <vector>

#include "core/messages.hpp"

namespace deltamap::navigation {

struct ObstacleParams {
  /// A gap of beams without an answer (not valid, dazzled, other) can hide something of this width anywhere beyond
  /// width / angle of the gap; there it counts as an obstacle. A single lost beam thus never stops the robot, a laser
  /// that sees nothing ahead does. A beam "beyond maximum" is clear up to that maximum and ends there: of what lies
  /// behind it says nothing. m, > 0
  double hidden_width_m = 0.15;
};

/// Where a scan saw (or could hide) something, in the robot's frame at Scan::time, not corrected for motion in the
/// sweep.
[[nodiscard]] std::vector<Point2> obstacles_of(const Scan& scan, const ObstacleParams& params);

/// The distance that the robot's centre can go forward with this curvature (turn rate / speed, 1/m; positive to the
/// left) before a disc of `radius_m` around it touches a point; `most_m` where nothing is touched on the way. Points
/// that the disc already touches count only where the robot would go towards them.
[[nodiscard]] double free_path_m(std::span<const Point2> obstacles_in_robot, double curvature_per_m, double radius_m,
                                 double most_m);

/// Distance from the robot's centre to the nearest point; infinity for none.
[[nodiscard]] double nearest_m(std::span<const Point2> obstacles_in_robot);

}  // namespace deltamap::navigation
