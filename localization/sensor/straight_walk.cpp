// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/straight_walk.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace deltamap::localization::sensor {
namespace {

constexpr int kSide = Tiled<CellState>::kSide;

struct Axis {
  int step = 0;
  std::ptrdiff_t stride = 0;                              ///< the same in a tile
  int cells = 0;                                          ///< of the grid
  int cells_left = 0;                                     ///< before the line leaves the tile or the grid
  double next = std::numeric_limits<double>::infinity();  ///< distance at which the line crosses the next border, cells
  double per_cell = next;

  Axis(double start, double along, int cell, int cells_of_grid, std::ptrdiff_t per_step) : cells{cells_of_grid} {
    step = along > 0.0 ? 1 : along < 0.0 ? -1 : 0;
    stride = step * per_step;
    if (step != 0) {
      next = (cell + (step > 0 ? 1 : 0) - start) / along;
      per_cell = std::abs(1.0 / along);
    }
    enter_tile(cell);
  }
  void enter_tile(int cell) {
    cells_left = step > 0 ? std::min(kSide - 1 - cell % kSide, cells - 1 - cell) : cell % kSide;
  }
};

const CellState* place_of(const OccupancyGrid& map, Cell cell) {
  return map.tiles().tile_at(cell) + Tiled<CellState>::slot_of(cell);
}

}  // namespace

Met first_met(const OccupancyGrid& map, const Point2& from, const Point2& along, double after_m, double until_m) {
  if (until_m <= after_m) return {};
  const GridGeometry& geometry = map.geometry();
  const Point2 start = (from + after_m * along - geometry.origin) / geometry.resolution_m;
  Cell cell{rounded_down(start.x()), rounded_down(start.y())};
  if (!geometry.contains(cell)) return {CellState::kUnknown, cell};

  const double until = (until_m - after_m) / geometry.resolution_m;
  Axis x{start.x(), along.x(), cell.column, geometry.width, 1};
  Axis y{start.y(), along.y(), cell.row, geometry.height, kSide};
  const CellState* at = place_of(map, cell);
  // Across a tile's border, where the map goes on there.
  const auto goes_on = [&](Axis& axis, int next) {
    if (!geometry.contains(cell)) return false;
    axis.enter_tile(next);
    at = place_of(map, cell);
    return true;
  };
  while (*at == CellState::kFree) {
    if (x.next < y.next) {
      if (x.next > until) return {};
      x.next += x.per_cell;
      cell.column += x.step;
      if (--x.cells_left >= 0) {
        at += x.stride;
      } else if (!goes_on(x, cell.column)) {
        return {CellState::kUnknown, cell};
      }
    } else {
      if (y.next > until) return {};
      y.next += y.per_cell;
      cell.row += y.step;
      if (--y.cells_left >= 0) {
        at += y.stride;
      } else if (!goes_on(y, cell.row)) {
        return {CellState::kUnknown, cell};
      }
    }
  }
  return {*at, cell};
}

}  // namespace deltamap::localization::sensor
