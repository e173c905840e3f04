// SPDX-License-Identifier: Apache-2.0
// The drawn hall after a change that is seen from way_round(): one container has gone, two have come.
#pragma once

#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::test {

inline OccupancyGrid changed_hall(double resolution_m = 0.05) {
  OccupancyGrid hall = drawn_hall(resolution_m);
  fill(hall, {8.0, 8.5}, {11.0, 10.0}, CellState::kFree);
  fill(hall, {12.0, 2.0}, {13.2, 4.0}, CellState::kOccupied);
  fill(hall, {4.0, 7.6}, {6.0, 8.8}, CellState::kOccupied);
  return hall;
}

}  // namespace deltamap::test
