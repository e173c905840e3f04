// SPDX-License-Identifier: Apache-2.0
// The first cell along a straight line that is not free, by the cell borders that the line crosses (after Amanatides
// and Woo, 1987, as core/grid/grid_ray.hpp), tile by tile so that a step costs an addition and a byte.
#pragma once

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::localization::sensor {

inline constexpr double kOutOfTheLaserM = 0.1;  ///< nothing so near the laser is an obstacle of the map

struct Met {
  CellState what = CellState::kFree;  ///< free: nothing up to the end; outside the map everything is unknown
  Cell cell;
};

/// What the line from `from` along the unit vector `along` meets first between the two distances.
[[nodiscard]] Met first_met(const OccupancyGrid& map, const Point2& from, const Point2& along, double after_m,
                            double until_m);

}  // namespace deltamap::localization::sensor
