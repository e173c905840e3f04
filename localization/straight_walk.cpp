// SPDX-License-Identifier: Apache-2.0
#include "localization/straight_walk.hpp"

#include <algorithm>
#include <limits>

namespace deltamap::localization {
namespace {

struct Axis {
  int step = 0;
  int cells_left = 0;  ///< before the line leaves the grid
  double next = 0.0;   ///< distance at which the line crosses the next border, cells
  double per_cell = 0.0;
};

Axis axis(double start, double along, int cell, int size) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (along == 0.0) return {0, size, kNever, kNever};
  if (along > 0.0) return {1, size - 1 - cell, (cell + 1 - start) / along, 1.0 / along};
  return {-1, cell, (cell - start) / along, -1.0 / along};
}

}  // namespace

Met first_met(const OccupancyGrid& map, const Point2& from, const Point2& along, double after_m, double until_m) {
  if (until_m <= after_m) return {};
  const GridGeometry& geometry = map.geometry();
  const Point2 start = (from + after_m * along - geometry.origin) / geometry.resolution_m;
  Cell cell{rounded_down(start.x()), rounded_down(start.y())};
  if (!geometry.contains(cell)) return {CellState::kUnknown, cell};

  const double until = (until_m - after_m) / geometry.resolution_m;
  Axis x = axis(start.x(), along.x(), cell.column, geometry.width);
  Axis y = axis(start.y(), along.y(), cell.row, geometry.height);
  const std::ptrdiff_t row_step = static_cast<std::ptrdiff_t>(y.step) * geometry.width;
  const CellState* at = map.cells().data() + geometry.index_of(cell);
  while (*at == CellState::kFree) {
    if (x.next < y.next) {
      if (x.next > until) return {};
      if (--x.cells_left < 0) return {CellState::kUnknown, cell};
      x.next += x.per_cell;
      cell.column += x.step;
      at += x.step;
    } else {
      if (y.next > until) return {};
      if (--y.cells_left < 0) return {CellState::kUnknown, cell};
      y.next += y.per_cell;
      cell.row += y.step;
      at += row_step;
    }
  }
  return {*at, cell};
}

}  // namespace deltamap::localization
