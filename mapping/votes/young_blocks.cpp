// SPDX-License-Identifier: Apache-2.0
#include "mapping/votes/young_blocks.hpp"

namespace deltamap::mapping::votes {

YoungBlocks::YoungBlocks(const ClearSpace& clear) : ages_{clear.blocks().width, clear.blocks().height, Age::kEmpty} {
  clear.for_each_solid([&](Cell block) { ages_.set(block, Age::kOld); });
}

void YoungBlocks::follow(const ClearSpace& clear, std::span<const CellChange> changes) {
  for (const CellChange& change : changes) {
    const Cell block = clear.lattice().block_of(change.cell);
    const Age age = ages_[block];
    if (change.after == CellState::kOccupied) {
      if (age == Age::kEmpty) ages_.set(block, Age::kYoung);
    } else if (age == Age::kYoung && !clear.is_solid(block)) {
      ages_.set(block, Age::kEmpty);
    }
  }
}

}  // namespace deltamap::mapping::votes
