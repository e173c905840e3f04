// SPDX-License-Identifier: Apache-2.0
// A hall that is its own image under quarter turns, for tests of places that look alike.
#pragma once

#include <numbers>

#include "tests/support/scans/cast_scan.hpp"

namespace deltamap::test {

/// 12 × 12 m with one block in each quarter: looks the same after every quarter turn about its middle (6, 6).
inline OccupancyGrid symmetric_hall() {
  OccupancyGrid hall{{280, 280, 0.05, {-1.0, -1.0}}};
  fill_box(hall, {-0.2, -0.2}, {12.2, 12.2}, CellState::kOccupied);
  fill_box(hall, {0.0, 0.0}, {12.0, 12.0}, CellState::kFree);
  for (const double x : {2.0, 8.5}) {
    for (const double y : {2.0, 8.5}) {
      fill_box(hall, {x, y}, {x + 1.5, y + 1.5}, CellState::kOccupied);
    }
  }
  return hall;
}

inline Pose2 turned_about_the_middle(const Pose2& pose, int quarters) {
  const Pose2 middle_from_map = inverse(Pose2{6.0, 6.0, 0.0});
  return Pose2{6.0, 6.0, 0.5 * std::numbers::pi * quarters} * middle_from_map * pose;
}

}  // namespace deltamap::test
