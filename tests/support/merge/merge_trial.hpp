// SPDX-License-Identifier: Apache-2.0
// Two overlapping parts of one world, the second turned and shifted by a known transform: what the paper validates its
// merge on (§3.4.2, Figures 7 and 8).
#pragma once

#include "core/geometry/angle.hpp"
#include "core/grid/occupancy_grid.hpp"
#include "core/random.hpp"
#include "mapping/registration/transformed_grid.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::test {

/// 35 × 35 m inside walls, four blocks of 10 × 10 m and 5 m corridors (paper §4, Figure 7), containers of 2.5 m missing
/// from the blocks so that no turn maps the hall onto itself. Solid, 0.025 m cells: finer than what is cut from it.
inline OccupancyGrid drawn_warehouse(std::uint64_t seed) {
  constexpr double kCell_m = 0.025;
  Random random{seed};
  OccupancyGrid hall{{1440, 1440, kCell_m, {-0.5, -0.5}}};
  fill(hall, {-0.2, -0.2}, {35.2, 35.2}, CellState::kOccupied);
  fill(hall, {0.0, 0.0}, {35.0, 35.0}, CellState::kFree);
  for (const double x : {5.0, 20.0}) {
    for (const double y : {5.0, 20.0}) {
      for (int i = 0; i < 16; ++i) {
        if (random.uniform() < 0.3) continue;
        const Point2 low{x + 2.5 * (i % 4), y + 2.5 * (i / 4)};
        fill(hall, low, low + Point2{2.5, 2.5}, CellState::kOccupied);
      }
    }
  }
  return hall;
}

using mapping::registration::moved_grid;
using mapping::registration::part_of;

}  // namespace deltamap::test
