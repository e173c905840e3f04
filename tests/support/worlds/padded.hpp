// SPDX-License-Identifier: Apache-2.0
// The same map in a larger rectangle: what it shows stays where it is.
#pragma once

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::test {

struct Padding {
  int left = 0, low = 0, right = 0, high = 0;  // cells
};

inline OccupancyGrid padded(const OccupancyGrid& map, const Padding& by) {
  const GridGeometry& g = map.geometry();
  OccupancyGrid wide{{g.width + by.left + by.right, g.height + by.low + by.high, g.resolution_m,
                      g.origin - g.resolution_m * Point2{by.left, by.low}}};
  for_each_known(map, [&](Cell cell, CellState state) { wide.set({cell.column + by.left, cell.row + by.low}, state); });
  return wide;
}

}  // namespace deltamap::test
