// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/surface.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "tests/support/worlds/container_hall.hpp"

namespace deltamap::localization::surfaces {
namespace {

CellBox whole(const OccupancyGrid& map) { return {{0, 0}, {map.width(), map.height()}}; }

/// A wall from one point to another, floor to its left only.
OccupancyGrid wall(const Point2& from, const Point2& to) {
  OccupancyGrid map{{120, 120, 0.05, {0.0, 0.0}}, CellState::kUnknown};
  const Point2 along = (to - from).normalized();
  for (int row = 0; row < map.height(); ++row) {
    for (int column = 0; column < map.width(); ++column) {
      const Point2 off = map.geometry().centre_of({column, row}) - from;
      const double left_m = along.x() * off.y() - along.y() * off.x();
      if (left_m > 0.025) map.set({column, row}, CellState::kFree);
      const bool beside = along.dot(off) >= 0.0 && along.dot(off) <= (to - from).norm();
      if (std::abs(left_m) <= 0.025 && beside) map.set({column, row}, CellState::kOccupied);
    }
  }
  return map;
}

TEST(Surface, MovesAsOneWithTheBackOfTheSameThing) {
  const Surface front{.centre = {2.0, 0.0}, .normal = {0.0, -1.0}, .half_length_m = 1.0};
  const Surface back{.centre = {2.5, 5.0}, .normal = {0.0, 1.0}, .half_length_m = 1.0};
  EXPECT_TRUE(move_as_one(front, back));
  EXPECT_TRUE(move_as_one(back, front));
  EXPECT_TRUE(move_as_one(front, front));
  Surface of_another = back;
  of_another.centre.x() = 6.0;
  EXPECT_FALSE(move_as_one(front, of_another)) << "beside it";
  of_another.centre = {2.0, 9.0};
  EXPECT_FALSE(move_as_one(front, of_another)) << "behind another thing";
  of_another = {.centre = {2.0, -3.0}, .normal = {0.0, 1.0}, .half_length_m = 1.0};
  EXPECT_FALSE(move_as_one(front, of_another)) << "across the aisle";
  of_another = {.centre = {3.0, 2.0}, .normal = {1.0, 0.0}, .half_length_m = 1.0};
  EXPECT_FALSE(move_as_one(front, of_another)) << "another direction: a move along the front is not seen there";
}

TEST(Surface, LiesTruerThanTheCellsOfAnObliqueWall) {
  for (const double degrees_of_wall : {7.0, 20.0, 33.0, 45.0, 71.0}) {
    const double a = radians(degrees_of_wall);
    const Point2 from{1.0, 0.5};
    const Point2 to = from + 4.0 * Point2{std::cos(a), std::sin(a)};
    const OccupancyGrid map = wall(from, to);
    const auto surfaces = surfaces_in(map, whole(map));
    ASSERT_FALSE(surfaces.empty()) << degrees_of_wall;
    double length_m = 0.0;
    for (const Surface& surface : surfaces) {
      length_m += 2.0 * surface.half_length_m;
      const Point2 left{-std::sin(a), std::cos(a)};
      EXPECT_GT(surface.normal.dot(left), std::cos(radians(2.0))) << degrees_of_wall;
      EXPECT_NEAR(left.dot(surface.centre - from), 0.0, 0.017) << degrees_of_wall;  // a third of a cell
    }
    EXPECT_GT(length_m, 3.5) << degrees_of_wall;
    EXPECT_LT(length_m, 4.3) << degrees_of_wall;
  }
}

TEST(Surface, FacesTheFloorOnEverySideOfAContainer) {
  const OccupancyGrid map = test::map_of(test::containers_in_order());
  int faces = 0;
  for (const Surface& surface : surfaces_in(map, whole(map))) {
    const Point2 before = surface.centre + 0.1 * surface.normal;
    EXPECT_EQ(map.at(map.geometry().cell_at(before)), CellState::kFree);
    EXPECT_FALSE(surface.two_sided);
    ++faces;
  }
  EXPECT_EQ(faces, 4 + 4 * 4);
}

TEST(Surface, IsNotFoundInClutter) {
  OccupancyGrid map{{80, 80, 0.05, {0.0, 0.0}}, CellState::kFree};
  Random random{3};
  for (int i = 0; i < 700; ++i)
    map.set({static_cast<int>(random.index_below(80)), static_cast<int>(random.index_below(80))}, CellState::kOccupied);
  EXPECT_LE(surfaces_in(map, whole(map)).size(), 2U);
}

}  // namespace
}  // namespace deltamap::localization::surfaces
