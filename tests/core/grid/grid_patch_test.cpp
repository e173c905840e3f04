// SPDX-License-Identifier: Apache-2.0
#include "core/grid/grid_patch.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap {
namespace {

TEST(GridPatch, LeadsFromOneGridToTheOther) {
  const OccupancyGrid before = test::drawn_grid({"#..", "..."});
  const OccupancyGrid after = test::drawn_grid({"...", ".# "});
  const auto changes = changes_between(before, after);
  EXPECT_EQ(changes.size(), 3u);
  EXPECT_EQ(patched(before, changes), after);
  EXPECT_EQ(bounding_box(changes), (CellBox{{0, 0}, {3, 2}}));
}

TEST(GridPatch, GrowsABoxInsideTheGridOnly) {
  const GridGeometry geometry{10, 10, 1.0, {0.0, 0.0}};
  EXPECT_EQ(grown({{1, 8}, {3, 9}}, 2, geometry), (CellBox{{0, 6}, {5, 10}}));
  EXPECT_TRUE(grown({}, 2, geometry).empty());
}

TEST(GridGeometry, FindsTheCellOfEveryPlace) {
  const GridGeometry geometry{10, 10, 0.5, {-1.0, -1.0}};
  EXPECT_EQ(geometry.cell_at({-1.0, -0.51}), (Cell{0, 0}));
  EXPECT_EQ(geometry.cell_at({-1.01, -1.5}), (Cell{-1, -1}));
  EXPECT_EQ(geometry.cell_at({3.99, 4.0}), (Cell{9, 10}));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double far : {-1e300, -1e12, 1e12, 1e300, kNan}) {
    EXPECT_FALSE(geometry.contains(geometry.cell_at({far, 0.0}))) << far;
    EXPECT_FALSE(geometry.contains(geometry.cell_at({0.0, far}))) << far;
  }
}

TEST(GridPatch, NamesAMapByItsContent) {
  const OccupancyGrid grid = test::drawn_grid({"#..", "..."});
  EXPECT_EQ(grid_hash(grid), grid_hash(test::drawn_grid({"#..", "..."})));
  EXPECT_NE(grid_hash(grid), grid_hash(test::drawn_grid({"#..", "..#"})));
  EXPECT_NE(grid_hash(grid), grid_hash(test::drawn_grid({"#..", "..."}, 0.5)));
}

}  // namespace
}  // namespace deltamap
