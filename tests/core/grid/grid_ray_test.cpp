// SPDX-License-Identifier: Apache-2.0
#include "core/grid/grid_ray.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/random.hpp"

namespace deltamap {
namespace {

const GridGeometry kGeometry{100, 100, 0.1, {-2.0, -3.0}};

std::vector<Cell> cells_along(const Point2& from, const Point2& to) {
  std::vector<Cell> cells;
  walk_ray(kGeometry, from, to, [&](Cell cell, double) {
    cells.push_back(cell);
    return true;
  });
  return cells;
}

TEST(GridRay, GoesFromTheFirstCellToTheLastInSingleSteps) {
  Random random{1};
  for (int i = 0; i < 2000; ++i) {
    const Point2 from{random.uniform(-2.0, 8.0), random.uniform(-3.0, 7.0)};
    const Point2 to{random.uniform(-2.0, 8.0), random.uniform(-3.0, 7.0)};
    const auto cells = cells_along(from, to);
    EXPECT_EQ(cells.front(), kGeometry.cell_at(from));
    EXPECT_EQ(cells.back(), kGeometry.cell_at(to));
    for (std::size_t k = 1; k < cells.size(); ++k) {
      EXPECT_EQ(std::abs(cells[k].column - cells[k - 1].column) + std::abs(cells[k].row - cells[k - 1].row), 1);
    }
  }
}

TEST(GridRay, TouchesOnlyCellsThatTheSegmentCrosses) {
  const Point2 from{-1.95, -2.95};
  const Point2 to{3.0, 1.2};
  walk_ray(kGeometry, from, to, [&](Cell cell, double entered_m) {
    const Point2 entry = from + (to - from).normalized() * (entered_m + 1e-9);
    EXPECT_LE((kGeometry.centre_of(cell) - entry).cwiseAbs().maxCoeff(), 0.05 + 1e-6);
    return true;
  });
}

TEST(GridRay, StandsStillOnABeamWithoutLength) {
  EXPECT_EQ(cells_along({0.0, 0.0}, {0.0, 0.0}), (std::vector<Cell>{kGeometry.cell_at({0.0, 0.0})}));
}

TEST(GridRay, StopsWhenTold) {
  int visited = 0;
  walk_ray(kGeometry, {0.0, 0.0}, {5.0, 0.0}, [&](Cell, double) { return ++visited < 3; });
  EXPECT_EQ(visited, 3);
}

}  // namespace
}  // namespace deltamap
