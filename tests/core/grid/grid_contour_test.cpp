// SPDX-License-Identifier: Apache-2.0
#include "core/grid/grid_contour.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap {
namespace {

bool is_contour(const OccupancyGrid& map, Cell cell) {
  const auto is_free = [&](int column, int row) { return map.at({column, row}) == CellState::kFree; };
  return map.at(cell) == CellState::kOccupied &&
         (is_free(cell.column + 1, cell.row) || is_free(cell.column - 1, cell.row) ||
          is_free(cell.column, cell.row + 1) || is_free(cell.column, cell.row - 1));
}

TEST(GridContour, IsOccupiedBesideFree) {
  const OccupancyGrid map = test::drawn_grid({"### ",  //
                                              "##. ",  //
                                              "### "});
  EXPECT_EQ(contour_cells(map), (std::vector<Cell>{{2, 0}, {1, 1}, {2, 2}}));
}

TEST(GridContour, IsTheSameWhereverTheBoxBegins) {
  Random random{3};
  for (const int width : {1, 7, 8, 9, 10, 17, 40}) {
    OccupancyGrid map{{width, 6, 0.1, {0.0, 0.0}}};
    for (int row = 0; row < map.height(); ++row) {
      for (int column = 0; column < width; ++column)
        map.set({column, row}, static_cast<CellState>(random.index_below(3)));
    }
    for (const CellBox& box :
         {CellBox{{0, 0}, {width, 6}}, CellBox{{3, 1}, {width - 2, 5}}, CellBox{{-4, -4}, {99, 99}}}) {
      std::vector<Cell> expected;
      for (int row = std::max(0, box.first.row); row < std::min(6, box.last.row); ++row) {
        for (int column = std::max(0, box.first.column); column < std::min(width, box.last.column); ++column) {
          if (is_contour(map, {column, row})) expected.push_back({column, row});
        }
      }
      EXPECT_EQ(contour_cells(map, box), expected) << width;
    }
  }
}

TEST(GridContour, OfAnEmptyMapIsEmpty) {
  EXPECT_TRUE(contour_cells(OccupancyGrid{}).empty());
  EXPECT_TRUE(contour_cells(OccupancyGrid{{20, 20, 0.1, {0.0, 0.0}}, CellState::kOccupied}).empty());
}

}  // namespace
}  // namespace deltamap
