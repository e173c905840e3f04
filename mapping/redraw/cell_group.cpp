// SPDX-License-Identifier: Apache-2.0
#include "mapping/redraw/cell_group.hpp"

#include <algorithm>
#include <vector>

namespace deltamap::mapping::redraw {

int group_size(const OccupancyGrid& map, Cell start, int enough) {
  std::vector<Cell> group{start};
  for (std::size_t next = 0; next < group.size() && static_cast<int>(group.size()) < enough; ++next) {
    for (int row = -1; row <= 1; ++row) {
      for (int column = -1; column <= 1; ++column) {
        const Cell cell{group[next].column + column, group[next].row + row};
        if (map.at(cell) == CellState::kOccupied && std::find(group.begin(), group.end(), cell) == group.end()) {
          group.push_back(cell);
        }
      }
    }
  }
  return static_cast<int>(group.size());
}

}  // namespace deltamap::mapping::redraw
