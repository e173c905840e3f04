// SPDX-License-Identifier: Apache-2.0
#include "surveying/grid_registration/edge_registration.hpp"

#include <gtest/gtest.h>

#include "tests/support/merge/merge_trial.hpp"

namespace deltamap::surveying::grid_registration {
namespace {

TEST(EdgeRegistration, FindsTheLastFractionOfACell) {
  const OccupancyGrid world = test::drawn_warehouse(5);
  const OccupancyGrid map = test::moved_grid(world, {}, 0.1);
  Random random{5};
  for (int trial = 0; trial < 5; ++trial) {
    const Pose2 local_from_map{0.3, -0.2, random.uniform(-3.0, 3.0)};
    const OccupancyGrid local = test::moved_grid(world, local_from_map, 0.1);
    const mapping::merge::LocalCells cells{local};
    const mapping::merge::CellMotion truth =
        mapping::merge::cell_motion(inverse(local_from_map), map.geometry(), cells);
    const mapping::merge::CellMotion start{truth.turn_rad + radians(random.uniform(-0.2, 0.2)),
                                           truth.column + random.uniform(-0.7, 0.7),
                                           truth.row + random.uniform(-0.7, 0.7)};
    const mapping::merge::CellMotion found = edge_registration(map, edge_cells(local), start, {});
    EXPECT_NEAR(found.column, truth.column, 0.05) << trial;
    EXPECT_NEAR(found.row, truth.row, 0.05) << trial;
    EXPECT_NEAR(degrees(turn_between(truth.turn_rad, found.turn_rad)), 0.0, 0.05) << trial;
  }
}

TEST(EdgeRegistration, LeavesTheLengthOfACorridorAlone) {
  OccupancyGrid corridor{{400, 40, 0.1, {0.0, 0.0}}, CellState::kFree};
  test::fill(corridor, {0.0, 0.0}, {40.0, 1.0}, CellState::kOccupied);
  test::fill(corridor, {0.0, 3.0}, {40.0, 4.0}, CellState::kOccupied);
  const mapping::merge::LocalCells cells{corridor};
  const mapping::merge::CellMotion truth = mapping::merge::cell_motion({}, corridor.geometry(), cells);
  const mapping::merge::CellMotion start{truth.turn_rad, truth.column + 1.5, truth.row + 0.4};
  const mapping::merge::CellMotion found = edge_registration(corridor, edge_cells(corridor), start, {});
  EXPECT_NEAR(found.row, truth.row, 0.02);
  EXPECT_NEAR(found.column, start.column, 0.02);
}

TEST(EdgeRegistration, KeepsAPoseThatNoEdgeHolds) {
  const OccupancyGrid hall = test::drawn_hall();
  const mapping::merge::LocalCells cells{hall};
  const mapping::merge::CellMotion far{0.3, 5000.0, -5000.0};
  EXPECT_EQ(edge_registration(hall, edge_cells(hall), far, {}), far);
}

}  // namespace
}  // namespace deltamap::surveying::grid_registration
