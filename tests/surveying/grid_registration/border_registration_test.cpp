// SPDX-License-Identifier: Apache-2.0
#include "surveying/grid_registration/border_registration.hpp"

#include <gtest/gtest.h>

#include "tests/support/merge/merge_trial.hpp"

namespace deltamap::surveying::grid_registration {
namespace {

TEST(BorderRegistration, FreesAPoseFromTheLattice) {
  const OccupancyGrid map = test::moved_grid(test::drawn_warehouse(5), {}, 0.1);
  const mapping::merge::OverlayMap overlay{map};
  for (const double turn_deg : {179.6, -90.3, 0.25}) {
    const Pose2 local_from_map{0.31, -0.22, radians(turn_deg)};
    const OccupancyGrid local = test::moved_grid(map, local_from_map, 0.1);
    const mapping::merge::LocalCells cells{local};
    const mapping::merge::CellMotion truth =
        mapping::merge::cell_motion(inverse(local_from_map), map.geometry(), cells);
    // As far off as if it were turned by whole quarters.
    const double quarter_rad = radians(90.0);
    const mapping::merge::CellMotion start{quarter_rad * std::round(truth.turn_rad / quarter_rad), truth.column + 0.1,
                                           truth.row - 0.1};
    ASSERT_LT(overlay.score(cells, start).acceptance(), 0.996) << turn_deg;
    const mapping::merge::CellMotion found = border_registration(map, edge_cells(local), start, {});
    EXPECT_GE(overlay.score(cells, found).acceptance(), 0.999) << turn_deg;
    EXPECT_NEAR(degrees(turn_between(truth.turn_rad, found.turn_rad)), 0.0, 0.03) << turn_deg;
  }
}

TEST(BorderRegistration, KeepsAMapThatLiesOnItself) {
  const OccupancyGrid hall = test::drawn_hall();
  const mapping::merge::CellMotion truth =
      mapping::merge::cell_motion({}, hall.geometry(), mapping::merge::LocalCells{hall});
  EXPECT_EQ(border_registration(hall, edge_cells(hall), truth, {}), truth);
}

TEST(BorderRegistration, KeepsAPoseThatNoEdgeHolds) {
  const OccupancyGrid hall = test::drawn_hall();
  const mapping::merge::CellMotion far{0.3, 5000.0, -5000.0};
  EXPECT_EQ(border_registration(hall, edge_cells(hall), far, {}), far);
}

}  // namespace
}  // namespace deltamap::surveying::grid_registration
