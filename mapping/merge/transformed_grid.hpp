// SPDX-License-Identifier: Apache-2.0
// A grid moved rigidly onto the cells of another: T(Δx, Δy, φ) M2 (paper §3.4.1).
#pragma once

#include "core/occupancy_grid.hpp"

namespace deltamap::mapping::merge {

/// Each target cell takes the state of the source cell that its centre falls in; unknown outside the source.
[[nodiscard]] OccupancyGrid transformed_grid(const OccupancyGrid& source, const Pose2& target_from_source,
                                             const GridGeometry& target);

/// The map with every cell that `local` knows, on the same geometry, taken from it.
[[nodiscard]] OccupancyGrid overridden(OccupancyGrid map, const OccupancyGrid& local);

}  // namespace deltamap::mapping::merge
