// SPDX-License-Identifier: Apache-2.0
// Is there a surface on or around a cell? Cells outside of the map are none.
#pragma once

#include <cmath>
#include <cstdlib>
#include <optional>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap {

[[nodiscard]] inline bool has_occupied(const OccupancyGrid& map, const CellBox& box) {
  for (int row = box.first.row; row < box.last.row; ++row) {
    for (int column = box.first.column; column < box.last.column; ++column) {
      if (map.at({column, row}) == CellState::kOccupied) return true;
    }
  }
  return false;
}

/// An occupied cell at most so many columns and rows away; 0: the cell itself.
[[nodiscard]] inline bool has_occupied_within(const OccupancyGrid& map, Cell cell, int reach_cells) {
  return has_occupied(map, grown({cell, {cell.column + 1, cell.row + 1}}, reach_cells));
}

/// The occupied cell that holds the place, else the one whose centre lies nearest to it of the innermost ring of cells
/// that has one; at most `reach_m` away.
[[nodiscard]] inline std::optional<Cell> occupied_near(const OccupancyGrid& map, const Point2& place, double reach_m) {
  const GridGeometry& geometry = map.geometry();
  const Cell centre = geometry.cell_at(place);
  if (map.at(centre) == CellState::kOccupied) return centre;
  const int rings = static_cast<int>(std::ceil(reach_m / geometry.resolution_m));
  double nearest_m2 = reach_m * reach_m;
  std::optional<Cell> nearest;
  for (int ring = 1; ring <= rings && !nearest; ++ring) {
    for (int row = -ring; row <= ring; ++row) {
      const int step = std::abs(row) == ring ? 1 : 2 * ring;
      for (int column = -ring; column <= ring; column += step) {
        const Cell cell{centre.column + column, centre.row + row};
        if (map.at(cell) != CellState::kOccupied) continue;
        const double away_m2 = (geometry.centre_of(cell) - place).squaredNorm();
        if (away_m2 > nearest_m2) continue;
        nearest_m2 = away_m2;
        nearest = cell;
      }
    }
  }
  return nearest;
}

}  // namespace deltamap
