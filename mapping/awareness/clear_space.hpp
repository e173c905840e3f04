// SPDX-License-Identifier: Apache-2.0
// How far the nearest surface of the map is, block by block, so that beams leap over what is clear: nine tenths of a
// beam's way lies where nothing could be met.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/grid_patch.hpp"
#include "core/occupancy_grid.hpp"

namespace deltamap::mapping::awareness {

class ClearSpace {
 public:
  /// Blocks from which on it makes no difference.
  static constexpr int kFarthest = 15;

  ClearSpace() = default;
  ClearSpace(const OccupancyGrid& map, int cells_per_block);

  /// `map` differs in these cells from the map before.
  void update(const OccupancyGrid& map, std::span<const CellChange> changes);

  /// Has the block an occupied cell?
  [[nodiscard]] bool is_solid(Cell block) const { return distance(block) == 0; }
  /// To the nearest solid block: rows or columns, whichever are more; at most kFarthest. The block lies on the map.
  [[nodiscard]] int distance(Cell block) const { return distance_[blocks_.index_of(block)]; }
  [[nodiscard]] const GridGeometry& blocks() const { return blocks_; }
  /// No cell within so many rows and columns of this one, which lies on the map, is occupied; 0: who knows.
  [[nodiscard]] int clear_cells_around(Cell cell) const {
    return (distance({cell.column / cells_per_block_, cell.row / cells_per_block_}) - 1) * cells_per_block_;
  }

 private:
  [[nodiscard]] bool has_occupied_cell(const OccupancyGrid& map, Cell block) const;
  /// Where solid blocks have come or gone.
  void measure(const CellBox& blocks);

  GridGeometry blocks_;
  int cells_per_block_ = 1;
  std::vector<std::uint8_t> solid_;
  std::vector<std::uint8_t> distance_;
};

/// Visits the occupied cells that the segment touches, in order: `visit(Cell, double entered_m, double before_m)` gets
/// the distances from `from` at which the beam enters the cell and has entered the cell before it, and answers whether
/// to go on. The way of walk_ray, with leaps.
template <typename Visit>
void walk_surfaces(const OccupancyGrid& map, const ClearSpace& clear, const Point2& from, const Point2& to,
                   Visit&& visit) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  constexpr int kLeastLeap = 3;  // cells; shorter ones cost more than they save
  const GridGeometry& geometry = map.geometry();
  const double length_m = (to - from).norm();
  const Cell last = geometry.cell_at(to);

  struct Axis {
    int step = 0;  // -1, 0, 1
    double metres_per_metre = 0.0;
    double per_cell_m = kNever;  // distance between borders
    double next_m = kNever;      // distance at which the beam crosses the next border
    int left = 0;                // borders to cross

    void begin_at(int cell, int last_cell, double cell_low_m, double resolution_m) {
      if (step == 0) return;
      left = std::max(0, step * (last_cell - cell));
      next_m = (step > 0 ? cell_low_m + resolution_m : cell_low_m) / metres_per_metre;
    }
  };
  const auto axis = [&](double delta) -> Axis {
    if (delta == 0.0) return {};
    const double per_metre = delta / length_m;
    return {delta > 0.0 ? 1 : -1, per_metre, geometry.resolution_m / std::abs(per_metre)};
  };
  Axis x = axis(to.x() - from.x());
  Axis y = axis(to.y() - from.y());
  Cell cell = geometry.cell_at(from);
  const auto begin = [&] {
    x.begin_at(cell.column, last.column, geometry.origin.x() + cell.column * geometry.resolution_m - from.x(),
               geometry.resolution_m);
    y.begin_at(cell.row, last.row, geometry.origin.y() + cell.row * geometry.resolution_m - from.y(),
               geometry.resolution_m);
  };
  begin();

  const double per_leapt_cell_m = std::min(x.per_cell_m, y.per_cell_m);
  double entered_m = 0.0;
  double before_m = 0.0;
  for (bool has_met_map = false;;) {
    if (geometry.contains(cell)) {
      has_met_map = true;
      const int clear_cells = clear.clear_cells_around(cell);
      if (clear_cells >= kLeastLeap) {
        const double leapt_m = entered_m + clear_cells * per_leapt_cell_m;
        if (!(leapt_m < length_m)) return;
        cell = geometry.cell_at(from + (to - from) * (leapt_m / length_m));
        begin();
        entered_m =
            std::max({0.0, x.step == 0 ? 0.0 : x.next_m - x.per_cell_m, y.step == 0 ? 0.0 : y.next_m - y.per_cell_m});
        before_m = entered_m;
        continue;
      }
      if (clear_cells < 0 && map[cell] == CellState::kOccupied && !visit(cell, entered_m, before_m)) return;
    } else if (has_met_map) {
      return;  // what has left the grid does not come back
    }
    if (x.left + y.left <= 0) return;
    Axis& crossed = y.left == 0 || (x.left > 0 && x.next_m < y.next_m) ? x : y;
    (&crossed == &x ? cell.column : cell.row) += crossed.step;
    --crossed.left;
    before_m = entered_m;
    entered_m = crossed.next_m;
    crossed.next_m += crossed.per_cell_m;
  }
}

}  // namespace deltamap::mapping::awareness
