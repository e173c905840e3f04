// SPDX-License-Identifier: Apache-2.0
#include "core/grid_patch.hpp"

#include <algorithm>

namespace deltamap {

CellBox grown(const CellBox& box, int cells, const GridGeometry& geometry) {
  if (box.empty()) return {};
  return {{std::max(0, box.first.column - cells), std::max(0, box.first.row - cells)},
          {std::min(geometry.width, box.last.column + cells), std::min(geometry.height, box.last.row + cells)}};
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
  for (std::size_t i = 0; i < before.cells().size(); ++i) {
    if (before.cells()[i] != after.cells()[i]) {
      changes.push_back({before.geometry().cell_of(i), before.cells()[i], after.cells()[i]});
    }
  }
  return changes;
}

}  // namespace deltamap
