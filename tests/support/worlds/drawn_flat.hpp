// SPDX-License-Identifier: Apache-2.0
// A small flat of three rooms for tests of localization.
#pragma once

#include "tests/support/scans/cast_scan.hpp"

namespace deltamap::test {

/// 10 × 6 m, nowhere the same.
inline OccupancyGrid drawn_flat() {
  OccupancyGrid map{{220, 140, 0.05, {-0.5, -0.5}}};
  fill_box(map, {-0.2, -0.2}, {10.2, 6.2}, CellState::kOccupied);
  fill_box(map, {0.0, 0.0}, {10.0, 6.0}, CellState::kFree);
  fill_box(map, {3.0, 0.0}, {3.2, 4.0}, CellState::kOccupied);
  fill_box(map, {6.0, 2.5}, {6.2, 6.0}, CellState::kOccupied);
  fill_box(map, {8.0, 1.0}, {8.9, 1.6}, CellState::kOccupied);
  fill_box(map, {1.0, 4.8}, {1.5, 6.0}, CellState::kOccupied);
  return map;
}

}  // namespace deltamap::test
