// SPDX-License-Identifier: Apache-2.0
// How much is joined to an occupied cell: a small object, or a surface?
#pragma once

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::mapping::redraw {

/// Occupied cells connected to `start` (8 neighbours), itself included, counted up to `enough`.
[[nodiscard]] int group_size(const OccupancyGrid& map, Cell start, int enough);

}  // namespace deltamap::mapping::redraw
