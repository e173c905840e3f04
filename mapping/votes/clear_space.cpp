// SPDX-License-Identifier: Apache-2.0
#include "mapping/votes/clear_space.hpp"

#include "core/grid/near_occupied.hpp"

namespace deltamap::mapping::votes {

ClearSpace::ClearSpace(const OccupancyGrid& map, const BlockLattice& lattice)
    : lattice_{lattice}, distance_{lattice.blocks().width, lattice.blocks().height, kFarthest} {
  CellBox all;
  for_each_known(map, [&](Cell cell, CellState state) {
    if (state != CellState::kOccupied) return;
    const Cell block = lattice_.block_of(cell);
    distance_.set(block, 0);
    all = united(all, {block, {block.column + 1, block.row + 1}});
  });
  measure(grown(all, kFarthest, blocks()));
}

void ClearSpace::update(const OccupancyGrid& map, std::span<const CellChange> changes) {
  std::vector<CellChange> turned;  // blocks that have become solid or clear
  for (const CellChange& change : changes) {
    const Cell block = lattice_.block_of(change.cell);
    const bool has_surface = has_occupied(map, lattice_.cells_of(block));
    if (has_surface == is_solid(block)) continue;
    distance_.set(block, static_cast<std::uint8_t>(has_surface ? 0 : kFarthest));
    turned.push_back({.cell = block});
  }
  measure(grown(bounding_box(turned), kFarthest, blocks()));
}

/// Two sweeps, after Rosenfeld and Pfaltz, "Sequential operations in digital picture processing", 1966. What lies
/// around the box is right already.
void ClearSpace::measure(const CellBox& box) {
  const auto at = [&](int column, int row) -> int {
    const Cell block{column, row};
    return blocks().contains(block) ? distance_[block] : kFarthest;
  };
  const auto take = [&](int column, int row, int nearest) {
    const Cell block{column, row};
    if (!is_solid(block)) distance_.set(block, static_cast<std::uint8_t>(std::min(kFarthest, nearest + 1)));
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

}  // namespace deltamap::mapping::votes
