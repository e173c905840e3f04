// SPDX-License-Identifier: Apache-2.0
// Square blocks of a map's cells. They are counted from the frame's origin, not from the map's corner: how much unknown
// space lies around a map does not decide which cells make a block.
#pragma once

#include <cmath>

#include "core/grid/grid_geometry.hpp"

namespace deltamap {

class BlockLattice {
 public:
  BlockLattice() = default;
  BlockLattice(const GridGeometry& map, int cells_per_block)
      : cells_per_block_{cells_per_block},
        ahead_{cells_ahead(map.origin.x(), map.resolution_m, cells_per_block),
               cells_ahead(map.origin.y(), map.resolution_m, cells_per_block)},
        blocks_{(map.width + ahead_.column + cells_per_block - 1) / cells_per_block,
                (map.height + ahead_.row + cells_per_block - 1) / cells_per_block,
                map.resolution_m * cells_per_block,
                {map.origin.x() - ahead_.column * map.resolution_m, map.origin.y() - ahead_.row * map.resolution_m}} {}

  /// Blocks lie on the map like cells of their own grid.
  [[nodiscard]] const GridGeometry& blocks() const { return blocks_; }
  [[nodiscard]] int cells_per_block() const { return cells_per_block_; }
  /// Cells of the first block that lie before the map's first cell.
  [[nodiscard]] Cell ahead() const { return ahead_; }
  /// The cell lies on the map.
  [[nodiscard]] Cell block_of(Cell cell) const {
    return {(cell.column + ahead_.column) / cells_per_block_, (cell.row + ahead_.row) / cells_per_block_};
  }
  /// The blocks that a box of cells touches; the box may reach beyond the map, and so may they.
  [[nodiscard]] CellBox blocks_of(const CellBox& cells) const {
    const auto along = [&](int cell, int ahead) { return floor_of(cell + ahead, cells_per_block_); };
    return {{along(cells.first.column, ahead_.column), along(cells.first.row, ahead_.row)},
            {along(cells.last.column - 1, ahead_.column) + 1, along(cells.last.row - 1, ahead_.row) + 1}};
  }
  /// Those at the map's border may lie outside.
  [[nodiscard]] CellBox cells_of(Cell block) const {
    const Cell first{block.column * cells_per_block_ - ahead_.column, block.row * cells_per_block_ - ahead_.row};
    return {first, {first.column + cells_per_block_, first.row + cells_per_block_}};
  }

 private:
  /// An origin between two cells of the frame's lattice counts as the lower one, whatever the rounding.
  static int cells_ahead(double origin_m, double resolution_m, int cells_per_block) {
    const int cells_from_frame = rounded_down(origin_m / resolution_m + 0.25);
    return cells_from_frame - cells_per_block * floor_of(cells_from_frame, cells_per_block);
  }
  static int floor_of(int number, int divisor) { return number / divisor - (number % divisor < 0 ? 1 : 0); }

  int cells_per_block_ = 1;
  Cell ahead_;
  GridGeometry blocks_;
};

}  // namespace deltamap
