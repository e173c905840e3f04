// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/surface_map.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "core/grid/grid_patch.hpp"
#include "tests/support/worlds/container_hall.hpp"

namespace deltamap::localization::surfaces {
namespace {

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
