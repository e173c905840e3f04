// SPDX-License-Identifier: Apache-2.0
#include "mapping/awareness/young_blocks.hpp"

namespace deltamap::mapping::awareness {

YoungBlocks::YoungBlocks(const OccupancyGrid& map, const GridGeometry& blocks, int cells_per_block)
    : blocks_{blocks}, cells_per_block_{cells_per_block}, ages_(blocks.cell_count(), Age::kEmpty) {
  for (std::size_t i = 0; i < map.cells().size(); ++i) {
    if (map.cells()[i] == CellState::kOccupied)
      ages_[blocks_.index_of(block_of(map.geometry().cell_of(i)))] = Age::kOld;
  }
}

void YoungBlocks::follow(const OccupancyGrid& map, std::span<const CellChange> changes) {
  for (const CellChange& change : changes) {
    const Cell block = block_of(change.cell);
    Age& age = ages_[blocks_.index_of(block)];
    if (change.after == CellState::kOccupied) {
      if (age == Age::kEmpty) age = Age::kYoung;
    } else if (age == Age::kYoung && !has_occupied(map, block)) {
      age = Age::kEmpty;
    }
  }
}

bool YoungBlocks::has_occupied(const OccupancyGrid& map, Cell block) const {
  const Cell first{block.column * cells_per_block_, block.row * cells_per_block_};
  for (int row = first.row; row < first.row + cells_per_block_; ++row) {
    for (int column = first.column; column < first.column + cells_per_block_; ++column) {
      if (map.at({column, row}) == CellState::kOccupied) return true;
    }
  }
  return false;
}

}  // namespace deltamap::mapping::awareness
