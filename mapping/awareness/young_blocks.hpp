// SPDX-License-Identifier: Apache-2.0
// Which blocks show nothing but what this run has written: a fork-lift that stopped, goods put down. What was in the
// run's first map has been believed for longer and is harder to overturn.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid_patch.hpp"
#include "core/occupancy_grid.hpp"

namespace deltamap::mapping::awareness {

class YoungBlocks {
 public:
  YoungBlocks() = default;
  /// All that the map shows is old. `blocks` begin at its cell (0, 0) and are `cells_per_block` wide.
  YoungBlocks(const OccupancyGrid& map, const GridGeometry& blocks, int cells_per_block);

  /// The changes have led to this map.
  void follow(const OccupancyGrid& map, std::span<const CellChange> changes);

  [[nodiscard]] bool is_young(Cell block) const { return ages_[blocks_.index_of(block)] == Age::kYoung; }

 private:
  enum class Age : std::uint8_t { kEmpty, kYoung, kOld };
  [[nodiscard]] Cell block_of(Cell cell) const { return {cell.column / cells_per_block_, cell.row / cells_per_block_}; }
  [[nodiscard]] bool has_occupied(const OccupancyGrid& map, Cell block) const;

  GridGeometry blocks_;
  int cells_per_block_ = 1;
  std::vector<Age> ages_;
};

}  // namespace deltamap::mapping::awareness
