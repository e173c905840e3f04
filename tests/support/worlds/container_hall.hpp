// SPDX-License-Identifier: Apache-2.0
// A hall of 12 × 8 m with four containers of 2 × 1.5 m, as a map has it and as a laser sees it. Surfaces of the world
// lie in the middle of the map's cells.
#pragma once

#include <array>

#include "core/grid/occupancy_grid.hpp"
#include "tests/support/scans/cast_scan.hpp"

namespace deltamap::test {

using Containers = std::array<Point2, 4>;  ///< their lower left corners, m

inline const Point2 kContainerSize{2.0, 1.5};

[[nodiscard]] inline Containers containers_in_order() { return {{{3.0, 2.0}, {7.0, 2.0}, {3.0, 5.0}, {7.0, 5.0}}}; }

[[nodiscard]] inline OccupancyGrid container_hall(const Containers& containers, double resolution_m, double shrunk_m) {
  const auto cells = [&](double length_m) { return static_cast<int>(std::lround(length_m / resolution_m)); };
  OccupancyGrid hall{{cells(13.0), cells(9.0), resolution_m, {-0.5, -0.5}}, CellState::kOccupied};
  const Point2 shrunk = Point2::Constant(shrunk_m);
  fill_box(hall, -shrunk, Point2{12.0, 8.0} + shrunk, CellState::kFree);
  for (const Point2& low : containers)
    fill_box(hall, low + shrunk, low + kContainerSize - shrunk, CellState::kOccupied);
  return hall;
}

[[nodiscard]] inline OccupancyGrid map_of(const Containers& containers) {
  return container_hall(containers, 0.05, 0.0);
}
[[nodiscard]] inline OccupancyGrid world_of(const Containers& containers) {
  return container_hall(containers, 0.005, 0.025);
}

}  // namespace deltamap::test
