// SPDX-License-Identifier: Apache-2.0
#include "mapping/gate/operator_cells.hpp"

#include <algorithm>
#include <utility>

namespace deltamap::mapping::gate {
namespace {

constexpr std::size_t kMostHeld = 64;  // an operator's words; the oldest goes

}  // namespace

void OperatorCells::hold(const GridGeometry& map, std::span<const CellChange> cells, Timestamp time) {
  Held held{time, {map.width, map.height, 0}};
  for (const CellChange& change : cells) {
    const Cell cell = change.cell;
    const CellBox around = grown({cell, {cell.column + 1, cell.row + 1}}, params_.margin_cells, map);
    for (int row = around.first.row; row < around.last.row; ++row) {
      for (int column = around.first.column; column < around.last.column; ++column) held.cells.set({column, row}, 1);
    }
  }
  if (held_.size() >= kMostHeld) held_.pop_front();
  held_.push_back(std::move(held));
}

/// A later look at a region is as old as its oldest scan, and never gets younger. What is proven anew rests on younger
/// scans alone: the votes before were void when the map changed.
std::vector<CellChange> OperatorCells::allowed(std::vector<CellChange> changes, const ScanSet& set) const {
  for (const Held& held : held_) {
    const bool holds = set.began < held.time || seconds(set.ended - held.time) < params_.hold_s;
    if (holds) std::erase_if(changes, [&](const CellChange& change) { return held.cells[change.cell] != 0; });
  }
  return changes;
}

}  // namespace deltamap::mapping::gate
