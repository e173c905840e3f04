// SPDX-License-Identifier: Apache-2.0
#include "core/grid_patch.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

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
  const GridGeometry& geometry = before.geometry();
  const auto width = static_cast<std::size_t>(geometry.width);
  for (int row = 0; row < geometry.height; ++row) {
    const std::size_t first = static_cast<std::size_t>(row) * width;
    if (std::memcmp(before.cells().data() + first, after.cells().data() + first, width) == 0)
      continue;  // most rows, and quick
    for (int column = 0; column < geometry.width; ++column) {
      const Cell cell{column, row};
      if (before[cell] != after[cell]) changes.push_back({cell, before[cell], after[cell]});
    }
  }
  return changes;
}

}  // namespace deltamap
