// SPDX-License-Identifier: Apache-2.0
// Is there a surface on or around a cell?
#pragma once

#include "core/occupancy_grid.hpp"

namespace deltamap {

/// An occupied cell at most so many columns and rows away; 0: the cell itself. Cells outside of the map are none.
[[nodiscard]] inline bool has_occupied_within(const OccupancyGrid& map, Cell cell, int reach_cells) {
  for (int row = cell.row - reach_cells; row <= cell.row + reach_cells; ++row) {
    for (int column = cell.column - reach_cells; column <= cell.column + reach_cells; ++column) {
      if (map.at({column, row}) == CellState::kOccupied) return true;
    }
  }
  return false;
}

}  // namespace deltamap
