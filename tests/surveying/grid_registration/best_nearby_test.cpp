// SPDX-License-Identifier: Apache-2.0
#include "surveying/grid_registration/best_nearby.hpp"

#include <gtest/gtest.h>

#include "tests/support/merge/merge_trial.hpp"

namespace deltamap::surveying::grid_registration {
namespace {

TEST(BestNearby, NeverTakesAWorsePose) {
  const OccupancyGrid hall = test::drawn_hall();
  const mapping::merge::LocalCells cells{hall};
  const mapping::merge::OverlayMap map{hall};
  const auto edges = edge_cells(hall);
  const mapping::merge::CellMotion truth = mapping::merge::cell_motion({}, hall.geometry(), cells);
  EXPECT_EQ(best_nearby(hall, edges, truth), truth) << "nothing fits better than a map on itself";
  const mapping::merge::CellMotion start{truth.turn_rad, truth.column + 0.6, truth.row};
  EXPECT_GT(map.score(cells, best_nearby(hall, edges, start, {.reach_cells = 0.2})).acceptance(),
            map.score(cells, start).acceptance());
}

TEST(BestNearby, LeavesRidgesThatNoAxisFollows) {
  constexpr double kMargin = 0.0001;
  const OccupancyGrid world = test::drawn_warehouse(5);
  const OccupancyGrid map = test::moved_grid(world, {}, 0.1);
  const mapping::merge::OverlayMap overlay{map};
  for (const double turn_deg : {3.0, -31.0, 47.0, 101.0, 163.0}) {
    const Pose2 local_from_world{0.31, -0.22, radians(turn_deg)};
    const OccupancyGrid local = test::moved_grid(world, local_from_world, 0.1);
    const mapping::merge::LocalCells cells{local};
    const auto edges = edge_cells(local);
    const mapping::merge::CellMotion truth =
        mapping::merge::cell_motion(inverse(local_from_world), map.geometry(), cells);
    const double best = overlay.score(cells, truth).acceptance();
    for (const double turned_deg : {-0.03, 0.03}) {
      const mapping::merge::CellMotion start{truth.turn_rad + radians(turned_deg), truth.column + 0.07,
                                             truth.row - 0.05};
      EXPECT_GT(overlay.score(cells, best_nearby(map, edges, start)).acceptance(), best - kMargin) << turn_deg;
    }
  }
}

TEST(BestNearby, KeepsAPoseThatNoEdgeHolds) {
  const OccupancyGrid hall = test::drawn_hall();
  const mapping::merge::CellMotion far{0.3, 5000.0, -5000.0};
  EXPECT_EQ(best_nearby(hall, edge_cells(hall), far), far);
}

}  // namespace
}  // namespace deltamap::surveying::grid_registration
