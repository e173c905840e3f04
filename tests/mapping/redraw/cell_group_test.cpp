// SPDX-License-Identifier: Apache-2.0
#include "mapping/redraw/cell_group.hpp"

#include <gtest/gtest.h>

#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::mapping::redraw {
namespace {

TEST(CellGroup, CountsDiagonalsAndStopsAtEnough) {
  const OccupancyGrid grid = test::drawn_grid({
      "#.....",  //
      ".#..##",  //
      "..#...",  //
  });
  EXPECT_EQ(group_size(grid, {0, 2}, 10), 3);
  EXPECT_EQ(group_size(grid, {0, 2}, 2), 2);
  EXPECT_EQ(group_size(grid, {4, 1}, 10), 2);
}

}  // namespace
}  // namespace deltamap::mapping::redraw
