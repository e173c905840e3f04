// SPDX-License-Identifier: Apache-2.0
// The cells along a beam, in order, after Amanatides and Woo, "A fast voxel traversal algorithm", 1987.
#pragma once

#include <cmath>
#include <limits>

#include "core/occupancy_grid.hpp"

namespace deltamap {

/// Visits every cell that the segment touches, from the cell of `from` to the cell of `to`, both included; cells
/// outside the grid are visited too (ask geometry.contains). `visit(Cell, double entered_m)` gets the distance from
/// `from` at which the beam enters the cell, and answers whether to go on.
template <typename Visit>
void walk_ray(const GridGeometry& geometry, const Point2& from, const Point2& to, Visit&& visit) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const double length_m = (to - from).norm();
  const Cell last = geometry.cell_at(to);
  Cell cell = geometry.cell_at(from);

  struct Axis {
    int step;           // -1, 0, 1
    double next_m;      // distance at which the beam crosses the next border
    double per_cell_m;  // distance between borders
  };
  const auto axis = [&](double start, double delta, double cell_low) -> Axis {
    if (delta == 0.0) return {0, kNever, kNever};
    const double per_metre = delta / length_m;
    const double border = delta > 0.0 ? cell_low + geometry.resolution_m : cell_low;
    return {delta > 0.0 ? 1 : -1, (border - start) / per_metre, geometry.resolution_m / std::abs(per_metre)};
  };
  Axis x = axis(from.x(), to.x() - from.x(), geometry.origin.x() + cell.column * geometry.resolution_m);
  Axis y = axis(from.y(), to.y() - from.y(), geometry.origin.y() + cell.row * geometry.resolution_m);

  // Counting borders, not comparing distances, ends the walk exactly in the last cell whatever the rounding.
  int columns_left = std::abs(last.column - cell.column);
  int rows_left = std::abs(last.row - cell.row);
  double entered_m = 0.0;
  while (visit(cell, entered_m) && columns_left + rows_left > 0) {
    const bool along_x = rows_left == 0 || (columns_left > 0 && x.next_m < y.next_m);
    Axis& crossed = along_x ? x : y;
    (along_x ? cell.column : cell.row) += crossed.step;
    --(along_x ? columns_left : rows_left);
    entered_m = crossed.next_m;
    crossed.next_m += crossed.per_cell_m;
  }
}

}  // namespace deltamap
