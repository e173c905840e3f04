// SPDX-License-Identifier: Apache-2.0
// The cells that a thing has changed, and what each was before it: a byte a cell of the box around them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/grid/grid_patch.hpp"

namespace deltamap::mapping::things {

class ThingCells {
 public:
  /// The state before; a cell that is owned already keeps its own.
  void own(Cell cell, CellState before);
  void drop(Cell cell);
  [[nodiscard]] std::optional<CellState> before(Cell cell) const {
    if (!box_.contains(cell) || before_[box_.index_of(cell)] == kNotOwned) return std::nullopt;
    return static_cast<CellState>(before_[box_.index_of(cell)]);
  }
  /// Owns a cell at most so many columns and rows away.
  [[nodiscard]] bool has_within(Cell cell, int reach_cells) const;

  [[nodiscard]] const CellBox& box() const { return box_; }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] std::size_t bytes() const { return before_.capacity(); }
  void clear() { *this = {}; }

  /// `visit(Cell, CellState before)`, row by row.
  template <typename Visit>
  void visit(Visit&& visit) const {
    for (std::size_t i = 0; i < before_.size(); ++i) {
      if (before_[i] == kNotOwned) continue;
      const auto width = static_cast<std::size_t>(box_.width());
      visit(Cell{box_.first.column + static_cast<int>(i % width), box_.first.row + static_cast<int>(i / width)},
            static_cast<CellState>(before_[i]));
    }
  }

 private:
  static constexpr std::uint8_t kNotOwned = 255;
  void make_room(Cell cell);

  CellBox box_;
  std::vector<std::uint8_t> before_;  // of each cell of the box
  std::size_t count_ = 0;
};

}  // namespace deltamap::mapping::things
