// SPDX-License-Identifier: Apache-2.0
// A room and a corridor, drawn in cells of 0.1 m.
#pragma once

#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::test {

/// 8 m by 6 m with a pillar.
inline OccupancyGrid room_with_pillar() {
  std::vector<std::string> lines(60, "#" + std::string(78, '.') + "#");
  lines.front() = lines.back() = std::string(80, '#');
  for (int row = 20; row < 25; ++row) lines[static_cast<std::size_t>(row)].replace(55, 5, "#####");
  return drawn_grid(lines, 0.1);
}

/// 2 m wide and 40 m long.
inline OccupancyGrid long_corridor() {
  std::vector<std::string> lines(20, std::string(400, '.'));
  lines.front() = lines.back() = std::string(400, '#');
  return drawn_grid(lines, 0.1);
}

}  // namespace deltamap::test
