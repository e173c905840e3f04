// SPDX-License-Identifier: Apache-2.0
// Grids drawn in a test: '#' occupied, '.' free, ' ' unknown; the first line is the highest y.
#pragma once

#include <string>
#include <vector>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::test {

inline OccupancyGrid drawn_grid(const std::vector<std::string>& lines, double resolution_m = 1.0,
                                Point2 origin = {0.0, 0.0}) {
  const auto height = static_cast<int>(lines.size());
  const auto width = static_cast<int>(lines.empty() ? 0 : lines.front().size());
  OccupancyGrid grid{{width, height, resolution_m, origin}};
  for (int row = 0; row < height; ++row) {
    const std::string& line = lines[static_cast<std::size_t>(height - 1 - row)];
    for (int column = 0; column < width; ++column) {
      const char c = line.at(static_cast<std::size_t>(column));
      grid.set({column, row}, c == '#' ? CellState::kOccupied : c == '.' ? CellState::kFree : CellState::kUnknown);
    }
  }
  return grid;
}

}  // namespace deltamap::test
