// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/grid_patch.hpp"
#include "core/random.hpp"
#include "localization/surfaces/surface_map.hpp"
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

TEST(SurfaceMap, FindsSurfacesOnlyWhereItIsAsked) {
  SurfaceMap surfaces{std::make_shared<const OccupancyGrid>(test::map_of(test::containers_in_order()))};
  const Point2 asked{3.0, 2.7};
  int found = 0;
  surfaces.near(asked, 0.5, [&](SurfaceMap::Id, const SurfaceRecord& record) {
    EXPECT_LT((record.surface.centre - asked).norm(), 3.6);  // in a tile of 2 m within half a metre
    ++found;
  });
  EXPECT_GT(found, 0);
}

TEST(SurfaceMap, KeepsWhatIsKnownOfASurfaceBesideAChange) {
  test::Containers containers = test::containers_in_order();
  const auto before = std::make_shared<const OccupancyGrid>(test::map_of(containers));
  SurfaceMap surfaces{before};
  std::vector<SurfaceMap::Id> ids;
  surfaces.near({6.0, 4.0}, 20.0, [&](SurfaceMap::Id id, const SurfaceRecord&) { ids.push_back(id); });
  for (const SurfaceMap::Id id : ids) surfaces.record(id).visits = 7.0;
  containers[0].y() += 0.4;
  const auto after = std::make_shared<const OccupancyGrid>(test::map_of(containers));
  EXPECT_TRUE(surfaces.apply(after, bounding_box(changes_between(*before, *after))));
  std::size_t kept = 0;
  std::size_t anew = 0;
  surfaces.near({6.0, 4.0}, 20.0, [&](SurfaceMap::Id, const SurfaceRecord& record) {
    (record.visits == 7.0 ? kept : anew) += 1;
    if (record.visits != 7.0) {
      EXPECT_LT((record.surface.centre - Point2{4.0, 3.2}).norm(), 1.7);
    }
  });
  EXPECT_GE(anew, 2U);  // both long faces at least
  EXPECT_GE(kept + 6, ids.size());
}

TEST(SurfaceMap, ForgetsAllOfAMapOfAnotherGeometry) {
  SurfaceMap surfaces{std::make_shared<const OccupancyGrid>(test::map_of(test::containers_in_order()))};
  surfaces.near({3.0, 2.7}, 0.5, [](SurfaceMap::Id, const SurfaceRecord&) {});
  OccupancyGrid other{{50, 50, 0.1, {0.0, 0.0}}, CellState::kFree};
  EXPECT_FALSE(surfaces.apply(std::make_shared<const OccupancyGrid>(other), {{0, 0}, {50, 50}}));
  surfaces.near({3.0, 2.7}, 0.5, [](SurfaceMap::Id, const SurfaceRecord&) { ADD_FAILURE(); });
}

}  // namespace
}  // namespace deltamap::localization::surfaces
