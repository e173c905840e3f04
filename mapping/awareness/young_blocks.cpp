// SPDX-License-Identifier: Apache-2.0
#include "mapping/awareness/young_blocks.hpp"

namespace deltamap::mapping::awareness {

YoungBlocks::YoungBlocks(const ClearSpace& clear, int cells_per_block)
    : blocks_{clear.blocks()}, cells_per_block_{cells_per_block}, ages_(blocks_.cell_count(), Age::kEmpty) {
  for (std::size_t i = 0; i < ages_.size(); ++i) {
    if (clear.is_solid(blocks_.cell_of(i))) ages_[i] = Age::kOld;
  }
}

void YoungBlocks::follow(const ClearSpace& clear, std::span<const CellChange> changes) {
  for (const CellChange& change : changes) {
    const Cell block{change.cell.column / cells_per_block_, change.cell.row / cells_per_block_};
    Age& age = ages_[blocks_.index_of(block)];
    if (change.after == CellState::kOccupied) {
      if (age == Age::kEmpty) age = Age::kYoung;
    } else if (age == Age::kYoung && !clear.is_solid(block)) {
      age = Age::kEmpty;
    }
  }
}

}  // namespace deltamap::mapping::awareness
