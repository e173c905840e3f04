// SPDX-License-Identifier: Apache-2.0
// Which blocks show nothing but what this run itself has written: a fork-lift that stopped, goods put down. What the
// run's first map shows has been believed for longer and is harder to overturn.
#pragma once

#include <cstdint>
#include <span>

#include "core/grid/grid_patch.hpp"
#include "core/grid/occupancy_grid.hpp"
#include "core/grid/tiled.hpp"
#include "mapping/votes/clear_space.hpp"

namespace deltamap::mapping::votes {

class ChangedThisRun {
 public:
  ChangedThisRun() = default;
  /// All that the map shows is old. `clear` is that of the map.
  explicit ChangedThisRun(const ClearSpace& clear);

  /// The changes have led to the map that `clear` is of now.
  void follow(const ClearSpace& clear, std::span<const CellChange> changes);

  [[nodiscard]] bool is_changed_this_run(Cell block) const { return ages_[block] == Age::kChanged; }

 private:
  enum class Age : std::uint8_t { kEmpty, kChanged, kFirst };

  Tiled<Age> ages_;  // of the blocks
};

}  // namespace deltamap::mapping::votes
