// SPDX-License-Identifier: Apache-2.0
#include "core/grid/grid_patch.hpp"

#include <algorithm>
#include <cassert>

namespace deltamap {

CellBox united(const CellBox& a, const CellBox& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {{std::min(a.first.column, b.first.column), std::min(a.first.row, b.first.row)},
          {std::max(a.last.column, b.last.column), std::max(a.last.row, b.last.row)}};
}

CellBox common(const CellBox& a, const CellBox& b) {
  const CellBox both{{std::max(a.first.column, b.first.column), std::max(a.first.row, b.first.row)},
                     {std::min(a.last.column, b.last.column), std::min(a.last.row, b.last.row)}};
  return both.empty() ? CellBox{} : both;
}

CellBox grown(const CellBox& box, int cells) {
  if (box.empty()) return {};
  return {{box.first.column - cells, box.first.row - cells}, {box.last.column + cells, box.last.row + cells}};
}

CellBox grown(const CellBox& box, int cells, const GridGeometry& geometry) {
  return common(grown(box, cells), geometry.box());
}

CellBox bounding_box(std::span<const CellChange> changes) {
  if (changes.empty()) return {};
  CellBox box{changes.front().cell, changes.front().cell};
  for (const CellChange& change : changes) {
    box.first = {std::min(box.first.column, change.cell.column), std::min(box.first.row, change.cell.row)};
    box.last = {std::max(box.last.column, change.cell.column), std::max(box.last.row, change.cell.row)};
  }
  ++box.last.column;
  ++box.last.row;
  return box;
}

OccupancyGrid patched(OccupancyGrid grid, std::span<const CellChange> changes) {
  for (const CellChange& change : changes) grid.set(change.cell, change.after);
  return grid;
}

std::vector<CellChange> changes_between(const OccupancyGrid& before, const OccupancyGrid& after) {
  assert(before.geometry() == after.geometry() && "only grids of one geometry can be compared cell by cell");
  std::vector<CellChange> changes;
  const auto has_changed = [&](Cell cell) { return before.tiles().tile_at(cell) != after.tiles().tile_at(cell); };
  const auto compare = [&](Cell first, std::span<const CellState> now) {
    for (int i = 0; i < static_cast<int>(now.size()); ++i) {
      const Cell cell{first.column + i, first.row};
      if (before[cell] != after[cell]) changes.push_back({cell, before[cell], after[cell]});
    }
  };
  after.tiles().visit_where(after.box(), has_changed, compare);  // most tiles are shared
  return changes;
}

}  // namespace deltamap
