// SPDX-License-Identifier: Apache-2.0
// What a line through the map meets first.
#include "localization/sensor/straight_walk.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/grid/grid_ray.hpp"
#include "core/random.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::localization::sensor {
namespace {

const Point2 kAlongX{1.0, 0.0};

OccupancyGrid wall_ahead() { return test::drawn_grid({"....#.", "......", "    .."}); }

TEST(FirstMet, IsTheFirstOccupiedCell) {
  const Met met = first_met(wall_ahead(), {0.5, 2.5}, kAlongX, 0.0, 10.0);
  EXPECT_EQ(met.what, CellState::kOccupied);
  EXPECT_EQ(met.cell, (Cell{4, 2}));
}

TEST(FirstMet, IsNothingBetweenTheTwoDistances) {
  EXPECT_EQ(first_met(wall_ahead(), {0.5, 2.5}, kAlongX, 0.0, 3.4).what, CellState::kFree);
  EXPECT_EQ(first_met(wall_ahead(), {0.5, 2.5}, kAlongX, 4.6, 5.0).what, CellState::kFree) << "behind the wall";
  EXPECT_EQ(first_met(wall_ahead(), {0.5, 2.5}, kAlongX, 3.6, 3.6).what, CellState::kFree) << "no way at all";
}

TEST(FirstMet, IsUnknownWhereTheMapKnowsNothingAndBeyondIt) {
  EXPECT_EQ(first_met(wall_ahead(), {0.5, 1.5}, {0.0, -1.0}, 0.0, 1.0).what, CellState::kUnknown);
  EXPECT_EQ(first_met(wall_ahead(), {0.5, 1.5}, kAlongX, 0.0, 10.0).what, CellState::kUnknown);
  EXPECT_EQ(first_met(wall_ahead(), {-0.5, 1.5}, kAlongX, 0.0, 0.2).what, CellState::kUnknown);
}

/// Straight from the definition: cell by cell.
Met met_by_a_plain_walk(const OccupancyGrid& map, const Point2& from, const Point2& to) {
  Met met;
  walk_ray(map.geometry(), from, to, [&](Cell cell, double) {
    met = {map.at(cell), cell};
    return met.what == CellState::kFree;
  });
  return met;
}

TEST(FirstMet, IsThatOfAPlainWalkInEveryDirectionAndAcrossTiles) {
  constexpr double kFar_m = 12.0;
  Random random{3};
  OccupancyGrid map{{150, 130, 0.1, {-2.0, 1.0}}, CellState::kFree};
  for (int i = 0; i < 150; ++i) {
    map.set({static_cast<int>(random.index_below(150)), static_cast<int>(random.index_below(130))},
            i % 2 == 0 ? CellState::kOccupied : CellState::kUnknown);
  }
  for (int i = 0; i < 1000; ++i) {
    const Point2 from{random.uniform(-1.9, 12.9), random.uniform(1.1, 13.9)};
    const double direction_rad = random.uniform(-3.1, 3.1);
    const Point2 along{std::cos(direction_rad), std::sin(direction_rad)};
    const Met expected = met_by_a_plain_walk(map, from, from + kFar_m * along);
    const Met met = first_met(map, from, along, 0.0, kFar_m);
    ASSERT_EQ(met.what, expected.what) << i;
    if (expected.what != CellState::kFree) {
      ASSERT_EQ(met.cell, expected.cell) << i;
    }
  }
}

}  // namespace
}  // namespace deltamap::localization::sensor
