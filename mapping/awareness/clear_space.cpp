// SPDX-License-Identifier: Apache-2.0
#include "mapping/awareness/clear_space.hpp"

#include "core/occupancy_grid.hpp"

namespace deltamap::mapping::awareness {

ClearSpace::ClearSpace(const OccupancyGrid& map, int cells_per_block)
    : blocks_{(map.width() + cells_per_block - 1) / cells_per_block,
              (map.height() + cells_per_block - 1) / cells_per_block, map.resolution_m() * cells_per_block,
              map.geometry().origin},
      cells_per_block_{cells_per_block},
      solid_(blocks_.cell_count(), 0),
      distance_(blocks_.cell_count(), kFarthest) {
  for (std::size_t i = 0; i < solid_.size(); ++i) solid_[i] = has_occupied_cell(map, blocks_.cell_of(i)) ? 1 : 0;
  measure({{0, 0}, {blocks_.width, blocks_.height}});
}

bool ClearSpace::has_occupied_cell(const OccupancyGrid& map, Cell block) const {
  const Cell first{block.column * cells_per_block_, block.row * cells_per_block_};
  for (int row = first.row; row < first.row + cells_per_block_; ++row) {
    for (int column = first.column; column < first.column + cells_per_block_; ++column) {
      if (map.at({column, row}) == CellState::kOccupied) return true;
    }
  }
  return false;
}

void ClearSpace::update(const OccupancyGrid& map, std::span<const CellChange> changes) {
  std::vector<CellChange> turned;  // blocks that have become solid or clear
  for (const CellChange& change : changes) {
    const Cell block{change.cell.column / cells_per_block_, change.cell.row / cells_per_block_};
    std::uint8_t& solid = solid_[blocks_.index_of(block)];
    const std::uint8_t is_solid = has_occupied_cell(map, block) ? 1 : 0;
    if (solid == is_solid) continue;
    solid = is_solid;
    turned.push_back({.cell = block});
  }
  measure(grown(bounding_box(turned), kFarthest, blocks_));
}

/// Two sweeps, after Rosenfeld and Pfaltz, "Sequential operations in digital picture processing", 1966. What lies
/// around the box is right already.
void ClearSpace::measure(const CellBox& box) {
  const auto at = [&](int column, int row) -> int {
    const Cell block{column, row};
    return blocks_.contains(block) ? distance_[blocks_.index_of(block)] : kFarthest;
  };
  const auto take = [&](int column, int row, int nearest) {
    const std::size_t index = blocks_.index_of({column, row});
    distance_[index] = solid_[index] != 0 ? 0 : static_cast<std::uint8_t>(std::min(kFarthest, nearest + 1));
  };
  for (int row = box.first.row; row < box.last.row; ++row) {
    for (int column = box.first.column; column < box.last.column; ++column) {
      take(column, row,
           std::min({at(column - 1, row), at(column - 1, row - 1), at(column, row - 1), at(column + 1, row - 1)}));
    }
  }
  for (int row = box.last.row - 1; row >= box.first.row; --row) {
    for (int column = box.last.column - 1; column >= box.first.column; --column) {
      const int behind =
          std::min({at(column + 1, row), at(column + 1, row + 1), at(column, row + 1), at(column - 1, row + 1)});
      take(column, row, std::min(behind, at(column, row) - 1));
    }
  }
}

}  // namespace deltamap::mapping::awareness
