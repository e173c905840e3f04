// SPDX-License-Identifier: Apache-2.0
// A grid moved rigidly onto the cells of another: T(Δx, Δy, φ) M2 (paper §3.4.1).
#pragma once

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::mapping::registration {

/// Each target cell takes the state of the source cell that its centre falls in; unknown outside the source.
[[nodiscard]] OccupancyGrid transformed_grid(const OccupancyGrid& source, const Pose2& target_from_source,
                                             const GridGeometry& target);

/// The grid turned and shifted and read at another resolution, on cells that hold all of it; cells lie at whole
/// multiples of the resolution.
[[nodiscard]] OccupancyGrid moved_grid(const OccupancyGrid& source, const Pose2& moved_from_source,
                                       double resolution_m);

/// The columns of a grid from one share of its width to another; 0 <= from_share < to_share <= 1.
[[nodiscard]] OccupancyGrid part_of(const OccupancyGrid& grid, double from_share, double to_share);

/// The map with every cell that `local` knows, on the same geometry, taken from it.
[[nodiscard]] OccupancyGrid overridden(OccupancyGrid map, const OccupancyGrid& local);

}  // namespace deltamap::mapping::registration
