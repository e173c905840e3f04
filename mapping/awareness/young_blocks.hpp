// SPDX-License-Identifier: Apache-2.0
// Which blocks show nothing but what this run has written: a fork-lift that stopped, goods put down. What was in the
// run's first map has been believed for longer and is harder to overturn.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid_patch.hpp"
#include "core/occupancy_grid.hpp"
#include "mapping/awareness/clear_space.hpp"

namespace deltamap::mapping::awareness {

class YoungBlocks {
 public:
  YoungBlocks() = default;
  /// All that the map shows is old. `clear` is that of the map, in blocks so wide.
  YoungBlocks(const ClearSpace& clear, int cells_per_block);

  /// The changes have led to the map that `clear` is of now.
  void follow(const ClearSpace& clear, std::span<const CellChange> changes);

  [[nodiscard]] bool is_young(Cell block) const { return ages_[blocks_.index_of(block)] == Age::kYoung; }

 private:
  enum class Age : std::uint8_t { kEmpty, kYoung, kOld };

  GridGeometry blocks_;
  int cells_per_block_ = 1;
  std::vector<Age> ages_;
};

}  // namespace deltamap::mapping::awareness
