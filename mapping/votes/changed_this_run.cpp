// SPDX-License-Identifier: Apache-2.0
#include "mapping/votes/changed_this_run.hpp"

namespace deltamap::mapping::votes {

ChangedThisRun::ChangedThisRun(const ClearSpace& clear)
    : ages_{clear.blocks().width, clear.blocks().height, Age::kEmpty} {
  clear.for_each_solid([&](Cell block) { ages_.set(block, Age::kFirst); });
}

void ChangedThisRun::follow(const ClearSpace& clear, std::span<const CellChange> changes) {
  for (const CellChange& change : changes) {
    const Cell block = clear.lattice().block_of(change.cell);
    const Age age = ages_[block];
    if (change.after == CellState::kOccupied) {
      if (age == Age::kEmpty) ages_.set(block, Age::kChanged);
    } else if (age == Age::kChanged && !clear.is_solid(block)) {
      ages_.set(block, Age::kEmpty);
    }
  }
}

}  // namespace deltamap::mapping::votes
