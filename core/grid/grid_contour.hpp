// SPDX-License-Identifier: Apache-2.0
// The contour of a map: occupied cells with a free neighbour (of 4), the surface that a laser sees. The inside of a
// solid block is left out, and so is what lies between occupied and unknown.
#pragma once

#include <vector>

#include "core/grid/grid_patch.hpp"
#include "core/grid/occupancy_grid.hpp"

namespace deltamap {

/// One of the four cells beside it is free.
[[nodiscard]] inline bool has_free_side(const OccupancyGrid& map, Cell cell) {
  return map.at({cell.column + 1, cell.row}) == CellState::kFree ||
         map.at({cell.column - 1, cell.row}) == CellState::kFree ||
         map.at({cell.column, cell.row + 1}) == CellState::kFree ||
         map.at({cell.column, cell.row - 1}) == CellState::kFree;
}

/// Of the whole map, row by row.
[[nodiscard]] std::vector<Cell> contour_cells(const OccupancyGrid& map);
/// Of the part in a box, clipped to the map; neighbours outside the box count.
[[nodiscard]] std::vector<Cell> contour_cells(const OccupancyGrid& map, const CellBox& box);

}  // namespace deltamap
