// SPDX-License-Identifier: Apache-2.0
// Free space that new surfaces have enclosed, away from the robot: the inside of a container that was put down, a gap
// behind it. Nobody knows any longer whether it is free.
#pragma once

#include <span>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/grid/grid_patch.hpp"
#include "core/grid/occupancy_grid.hpp"

namespace deltamap::mapping::redraw {

/// The pieces of free space to which any of the `starts` belongs and from which no way over cells' sides leads to a
/// place where the robot was, nor to more than `most_m2` of floor. Starts that are not free say nothing.
[[nodiscard]] std::vector<Cell> enclosed_free_space(const OccupancyGrid& map, std::span<const Cell> starts,
                                                    std::span<const Point2> robot_was, double most_m2);

}  // namespace deltamap::mapping::redraw
