// SPDX-License-Identifier: Apache-2.0
#include "experiments/verdict/map_distances.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::experiments {

MapDistances::MapDistances(const OccupancyGrid& map)
    : geometry_{map.geometry()},
      low_x_m_{static_cast<float>(map.geometry().origin.x())},
      low_y_m_{static_cast<float>(map.geometry().origin.y())},
      cells_a_metre_{static_cast<float>(1.0 / map.resolution_m())},
      columns_{static_cast<float>(map.width())},
      rows_{static_cast<float>(map.height())},
      stride_{static_cast<std::size_t>(map.width())},
      to_obstacle_{distances(map, CellState::kOccupied)},
      to_floor_{distances(map, CellState::kFree)} {}

/// Exact up to kMost_m: along every column first, then the best of a row's columns.
MapDistances::Table MapDistances::distances(const OccupancyGrid& map, CellState to) const {
  const int most = static_cast<int>(static_cast<double>(kMost_m) / map.resolution_m()) + 1;  // cells
  std::vector<int> upright(map.geometry().cell_count(), most);
  const auto at = [&](int column, int row) -> int& { return upright[map.geometry().index_of({column, row})]; };
  for (int column = 0; column < map.width(); ++column) {
    for (int row = 0; row < map.height(); ++row) {
      const int before = row > 0 ? at(column, row - 1) + 1 : most;
      at(column, row) = map[{column, row}] == to ? 0 : std::min(most, before);
    }
    for (int row = map.height() - 2; row >= 0; --row) {
      at(column, row) = std::min(at(column, row), at(column, row + 1) + 1);
    }
  }
  Table table(map.geometry().cell_count());
  for (int row = 0; row < map.height(); ++row) {
    for (int column = 0; column < map.width(); ++column) {
      int best2 = most * most;
      for (int aside = -most; aside <= most; ++aside) {
        const int other = column + aside;
        if (other < 0 || other >= map.width() || aside * aside >= best2) continue;
        const int along = at(other, row);
        best2 = std::min(best2, aside * aside + along * along);
      }
      const double distance_m = std::min(static_cast<double>(kMost_m), std::sqrt(best2) * map.resolution_m());
      table[map.geometry().index_of({column, row})] =
          static_cast<std::uint8_t>(std::lround(distance_m / static_cast<double>(kUnit_m)));
    }
  }
  return table;
}

}  // namespace deltamap::experiments
