// SPDX-License-Identifier: Apache-2.0
// What is known to stand around the robot for now although the present scan does not show it: beside and behind the
// laser's field, between two beams, or where a beam has brought nothing back. Adds to what a scan saw, never takes
// away.
#pragma once

#include <vector>

#include "core/messages.hpp"
#include "core/transient_obstacles.hpp"

namespace deltamap::navigation {

struct RememberedParams {
  double within_m = 3.0;  ///< nearer things count, from the robot's middle; > 0
  double hull_m = 0.26;   ///< where the robot stands nothing else does; >= 0
  double clear_m = 0.15;  ///< a beam that ends so far behind a thing has gone through its place; > 0
};

/// Middles of the blocks in the robot's frame at Scan::time; none while the pose is not tracked. What every beam in its
/// direction goes through has left.
[[nodiscard]] std::vector<Point2> remembered_obstacles(const TransientObstacles& transients, const TrackedScan& tracked,
                                                       const RememberedParams& params);

}  // namespace deltamap::navigation
