// SPDX-License-Identifier: Apache-2.0
// The cells along a beam, in order, after Amanatides and Woo, "A fast voxel traversal algorithm", 1987.
#pragma once

#include <cmath>
#include <limits>

#include "core/grid/occupancy_grid.hpp"

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
    int step;           // -1, 1; 0 where no border is to be crossed
    int left;           // borders to cross: ends the walk exactly in the last cell, whatever the rounding
    double next_m;      // distance at which the beam crosses the next border; never where none is left
    double per_cell_m;  // distance between borders

    void cross(int& coordinate) {
      coordinate += step;
      next_m = --left > 0 ? next_m + per_cell_m : kNever;
    }
  };
  const auto axis = [&](double start, double delta, double cell_low, int from_cell, int to_cell) -> Axis {
    if (from_cell == to_cell) return {0, 0, kNever, kNever};
    const double per_metre = delta / length_m;
    const double border = delta > 0.0 ? cell_low + geometry.resolution_m : cell_low;
    return {delta > 0.0 ? 1 : -1, std::abs(to_cell - from_cell), (border - start) / per_metre,
            geometry.resolution_m / std::abs(per_metre)};
  };
  const Point2 low = geometry.origin + geometry.resolution_m * Point2{cell.column, cell.row};
  Axis x = axis(from.x(), to.x() - from.x(), low.x(), cell.column, last.column);
  Axis y = axis(from.y(), to.y() - from.y(), low.y(), cell.row, last.row);
  double entered_m = 0.0;
  while (visit(cell, entered_m) && x.left + y.left > 0) {
    if (x.next_m < y.next_m) {
      entered_m = x.next_m;
      x.cross(cell.column);
    } else {
      entered_m = y.next_m;
      y.cross(cell.row);
    }
  }
}

}  // namespace deltamap
