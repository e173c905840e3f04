// SPDX-License-Identifier: Apache-2.0
#include "tool/picture/changed_places.hpp"

#include <cstdint>
#include <unordered_map>

namespace deltamap::tool::picture {
namespace {

CellBox box_of(Cell cell) { return {cell, {cell.column + 1, cell.row + 1}}; }

std::int64_t key_of(Cell cell) { return (std::int64_t{cell.row} << 32) + cell.column; }

}  // namespace

std::vector<CellBox> changed_places(std::span<const CellChange> changes, int reach_cells) {
  std::unordered_map<std::int64_t, Cell> left;
  for (const CellChange& change : changes) left.emplace(key_of(change.cell), change.cell);
  std::vector<CellBox> places;
  std::vector<Cell> border;
  for (const CellChange& change : changes) {
    if (left.erase(key_of(change.cell)) == 0) continue;
    CellBox place = box_of(change.cell);
    border.assign(1, change.cell);
    while (!border.empty()) {
      const Cell middle = border.back();
      border.pop_back();
      place = united(place, box_of(middle));
      for (int row = -reach_cells; row <= reach_cells; ++row) {
        for (int column = -reach_cells; column <= reach_cells; ++column) {
          const Cell near{middle.column + column, middle.row + row};
          if (left.erase(key_of(near)) > 0) border.push_back(near);
        }
      }
    }
    places.push_back(place);
  }
  return places;
}

}  // namespace deltamap::tool::picture
