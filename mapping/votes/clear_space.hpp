// SPDX-License-Identifier: Apache-2.0
// How far the nearest surface of the map is, block by block, so that beams leap over what is clear: nine tenths of a
// beam's way lies where nothing could be met.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "core/grid/block_lattice.hpp"
#include "core/grid/grid_patch.hpp"
#include "core/grid/occupancy_grid.hpp"
#include "core/grid/tiled.hpp"

namespace deltamap::mapping::votes {

class ClearSpace {
 public:
  /// Blocks from which on it makes no difference.
  static constexpr int kFarthest = 15;

  ClearSpace() = default;
  ClearSpace(const OccupancyGrid& map, const BlockLattice& lattice);

  /// `map` differs in these cells from the map before.
  void update(const OccupancyGrid& map, std::span<const CellChange> changes);

  /// Has the block an occupied cell?
  [[nodiscard]] bool is_solid(Cell block) const { return distance(block) == 0; }
  /// To the nearest solid block: rows or columns, whichever are more; at most kFarthest. The block lies on the map.
  [[nodiscard]] int distance(Cell block) const { return distance_[block]; }
  /// `visit(Cell block)` for each solid block, row by row.
  template <typename Visit>
  void for_each_solid(Visit&& visit) const {
    distance_.visit_written(blocks().box(), [&](Cell first, std::span<const std::uint8_t> distances) {
      for (int i = 0; i < static_cast<int>(distances.size()); ++i) {
        if (distances[static_cast<std::size_t>(i)] == 0) visit(Cell{first.column + i, first.row});
      }
    });
  }
  /// The same for those that touch a block, and the block itself; it may lie beyond the map's border.
  template <typename Visit>
  void for_each_solid_around(Cell block, Visit&& visit) const {
    distance_.visit_around(block, 1, blocks(), [&](Cell at, std::uint8_t distance) {
      if (distance == 0) visit(at);
    });
  }
  [[nodiscard]] const BlockLattice& lattice() const { return lattice_; }
  [[nodiscard]] const GridGeometry& blocks() const { return lattice_.blocks(); }
  /// No cell within so many rows and columns of this one, which lies on the map, is occupied; 0: who knows.
  [[nodiscard]] int clear_cells_around(Cell cell) const { return clear_cells_around_block(lattice_.block_of(cell)); }
  /// The same for every cell of a block.
  [[nodiscard]] int clear_cells_around_block(Cell block) const {
    return (distance(block) - 1) * lattice_.cells_per_block();
  }

 private:
  /// Where solid blocks have come or gone.
  void measure(const CellBox& blocks);

  BlockLattice lattice_;
  Tiled<std::uint8_t> distance_;
};

/// One coordinate of a beam, in cells.
struct BeamAxis {
  double start = 0.0;
  int first = 0;  // cell in which it begins
  int last = 0;   // cell in which it ends
  int step = 0;   // -1, 0, 1
  double cells_per_m = 0.0;
  double per_cell_m = std::numeric_limits<double>::infinity();  // distance between borders

  BeamAxis(double start_cells, double delta_cells, double length_m, int first_cell, int last_cell)
      : start{start_cells}, first{first_cell}, last{last_cell} {
    if (delta_cells == 0.0) return;
    step = delta_cells > 0.0 ? 1 : -1;
    cells_per_m = delta_cells / length_m;
    per_cell_m = std::abs(length_m / delta_cells);
  }
  [[nodiscard]] int cell_at(double way_m) const {
    const double place = start + cells_per_m * way_m;
    return place < 0.0 ? -1 : static_cast<int>(place);
  }
  /// Where the beam leaves the cell.
  [[nodiscard]] double leaves_m(int cell) const {
    return step == 0 ? per_cell_m : (cell + (step > 0 ? 1 : 0) - start) * (step * per_cell_m);
  }
};

/// Visits the occupied cells that the segment touches, in order: `visit(Cell, double entered_m, double before_m)` gets
/// the distances from `from` at which the beam enters the cell and has entered the cell before it, and answers whether
/// to go on. The way of walk_ray, with leaps; `from` lies on the map.
template <typename Visit>
void walk_surfaces(const OccupancyGrid& map, const ClearSpace& clear, const Point2& from, const Point2& to,
                   Visit&& visit) {
  constexpr int kLeastLeap = 2;  // cells; shorter ones cost more than they save
  const GridGeometry& geometry = map.geometry();
  const double length_m = (to - from).norm();
  const Cell first = geometry.cell_at(from);
  const Cell last = geometry.cell_at(to);
  const Point2 start = (from - geometry.origin) / geometry.resolution_m;
  const Point2 delta = (to - from) / geometry.resolution_m;
  const BeamAxis x{start.x(), delta.x(), length_m, first.column, last.column};
  const BeamAxis y{start.y(), delta.y(), length_m, first.row, last.row};
  // A little less than a cell, so that rounding does not carry a leap across one border more.
  const double per_leapt_cell_m = (1.0 - 1e-9) * std::min(x.per_cell_m, y.per_cell_m);

  // Leaps go from block to block: dividing by the cells of a block each time takes longer than all the rest.
  const double blocks_per_cell = 1.0 / clear.lattice().cells_per_block();
  const Cell ahead = clear.lattice().ahead();
  const Point2 start_block = (start + Point2{ahead.column, ahead.row}) * blocks_per_cell;
  const Point2 blocks_per_m{x.cells_per_m * blocks_per_cell, y.cells_per_m * blocks_per_cell};

  double way_m = 0.0;  // the beam is in the cell there
  Cell cell = first;
  while (geometry.contains(cell)) {
    int clear_cells = clear.clear_cells_around(cell);
    if (clear_cells >= kLeastLeap) {
      while (clear_cells >= kLeastLeap) {
        way_m += clear_cells * per_leapt_cell_m;
        if (!(way_m < length_m)) return;
        const Point2 place = start_block + way_m * blocks_per_m;
        const Cell block{static_cast<int>(place.x()), static_cast<int>(place.y())};
        clear_cells = clear.blocks().contains(block) ? clear.clear_cells_around_block(block) : 0;
      }
      cell = {x.cell_at(way_m), y.cell_at(way_m)};
      continue;
    }
    double next_x_m = x.leaves_m(cell.column);
    double next_y_m = y.leaves_m(cell.row);
    double before_m = 0.0;
    double entered_m = 0.0;
    if (x.step != 0) entered_m = std::max(entered_m, next_x_m - x.per_cell_m);
    if (y.step != 0) entered_m = std::max(entered_m, next_y_m - y.per_cell_m);
    while (clear_cells < kLeastLeap) {
      if (clear_cells < 0 && map[cell] == CellState::kOccupied && !visit(cell, entered_m, before_m)) return;
      if (cell == last) return;
      before_m = entered_m;
      // Rounding must not carry it past the last column or row.
      const bool along_x = cell.row == y.last || (cell.column != x.last && next_x_m < next_y_m);
      if (along_x) {
        cell.column += x.step;
        entered_m = next_x_m;
        next_x_m += x.per_cell_m;
      } else {
        cell.row += y.step;
        entered_m = next_y_m;
        next_y_m += y.per_cell_m;
      }
      if (!geometry.contains(cell) || entered_m > length_m) return;
      clear_cells = clear.clear_cells_around(cell);
    }
    way_m = entered_m;
  }
}

}  // namespace deltamap::mapping::votes
