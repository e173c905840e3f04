// SPDX-License-Identifier: Apache-2.0
// A room small enough to reckon with, which tells all three coordinates of a pose.
#pragma once

#include "core/grid/occupancy_grid.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::test {

/// A room of 6 × 4 m with a pillar.
[[nodiscard]] inline OccupancyGrid pillar_room() {
  OccupancyGrid map{{140, 100, 0.05, {-0.5, -0.5}}, CellState::kOccupied};
  fill_box(map, {0.0, 0.0}, {6.0, 4.0}, CellState::kFree);
  fill_box(map, {4.0, 2.0}, {4.4, 2.6}, CellState::kOccupied);
  return map;
}

}  // namespace deltamap::test
