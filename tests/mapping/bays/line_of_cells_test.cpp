// SPDX-License-Identifier: Apache-2.0
#include "mapping/bays/line_of_cells.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/angle.hpp"

namespace deltamap::mapping::bays {
namespace {

constexpr CellLayout kLayout{.edge_m = 0.2, .columns = 12, .rows = 6};

TEST(LineOfCells, ALineAlongARowPassesEachOfItsCells) {
  const LineOfCells line = cells_on_line(kLayout, {-1.0, 0.3}, {1.0, 0.0}, 5.0);
  ASSERT_EQ(line.count, 12);
  for (int i = 0; i < line.count; ++i) {
    EXPECT_EQ(line[i].cell, 12 + i);
    EXPECT_NEAR(line[i].from_m, 1.0 + 0.2 * i, 1e-9);
    EXPECT_NEAR(line[i].to_m, 1.2 + 0.2 * i, 1e-9);
  }
}

TEST(LineOfCells, EachCellBeginsWhereTheOneBeforeEndsAndTouchesIt) {
  for (int heading_deg = 3; heading_deg < 90; heading_deg += 7) {
    const double heading_rad = radians(heading_deg);
    const LineOfCells line = cells_on_line(kLayout, {0.05, 0.05}, {std::cos(heading_rad), std::sin(heading_rad)}, 5.0);
    ASSERT_GT(line.count, 5);
    for (int i = 1; i < line.count; ++i) {
      EXPECT_DOUBLE_EQ(line[i].from_m, line[i - 1].to_m);
      const int step = line[i].cell - line[i - 1].cell;
      EXPECT_TRUE(step == 1 || step == kLayout.columns) << step;
    }
  }
}

TEST(LineOfCells, NoneWhereItPassesByOrEntersTooFarAway) {
  EXPECT_EQ(cells_on_line(kLayout, {-1.0, 1.3}, {1.0, 0.0}, 5.0).count, 0);
  EXPECT_EQ(cells_on_line(kLayout, {3.0, 0.3}, {1.0, 0.0}, 5.0).count, 0) << "they lie behind";
  EXPECT_EQ(cells_on_line(kLayout, {-1.0, 0.3}, {1.0, 0.0}, 0.9).count, 0);
}

}  // namespace
}  // namespace deltamap::mapping::bays
