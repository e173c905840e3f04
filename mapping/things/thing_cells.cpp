// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/thing_cells.hpp"

#include <algorithm>

namespace deltamap::mapping::things {
namespace {

constexpr int kRoom = 8;  // cells that a box grows by beyond what it must

}  // namespace

void ThingCells::make_room(Cell cell) {
  if (box_.contains(cell)) return;
  const CellBox wanted = united(box_, grown({cell, {cell.column + 1, cell.row + 1}}, kRoom));
  std::vector<std::uint8_t> larger(wanted.cell_count(), kNotOwned);
  visit([&](Cell owned, CellState state) { larger[wanted.index_of(owned)] = static_cast<std::uint8_t>(state); });
  box_ = wanted;
  before_ = std::move(larger);
}

void ThingCells::own(Cell cell, CellState before) {
  make_room(cell);
  std::uint8_t& mine = before_[box_.index_of(cell)];
  if (mine != kNotOwned) return;
  mine = static_cast<std::uint8_t>(before);
  ++count_;
}

void ThingCells::drop(Cell cell) {
  if (!box_.contains(cell)) return;
  std::uint8_t& mine = before_[box_.index_of(cell)];
  if (mine == kNotOwned) return;
  mine = kNotOwned;
  --count_;
}

bool ThingCells::has_within(Cell cell, int reach_cells) const {
  const CellBox around = common(grown({cell, {cell.column + 1, cell.row + 1}}, reach_cells), box_);
  for (int row = around.first.row; row < around.last.row; ++row) {
    for (int column = around.first.column; column < around.last.column; ++column) {
      if (before_[box_.index_of({column, row})] != kNotOwned) return true;
    }
  }
  return false;
}

}  // namespace deltamap::mapping::things
