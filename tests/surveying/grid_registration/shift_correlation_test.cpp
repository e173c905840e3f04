// SPDX-License-Identifier: Apache-2.0
#include "surveying/grid_registration/shift_correlation.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/grid/grid_contour.hpp"
#include "tests/support/merge/merge_trial.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::surveying::grid_registration {
namespace {

class Shifts : public testing::Test {
 protected:
  [[nodiscard]] ShiftCorrelation correlation(int least_cells_per_pixel, int most_pixels) const {
    return {hall, contour_cells(hall), cells, least_cells_per_pixel, most_pixels};
  }
  void expect_truth(const mapping::merge::CellMotion& found, double tolerance_cells) const {
    EXPECT_NEAR(turn_between(truth.turn_rad, found.turn_rad), 0.0, 1e-9);
    EXPECT_NEAR(found.column, truth.column, tolerance_cells);
    EXPECT_NEAR(found.row, truth.row, tolerance_cells);
  }

  const OccupancyGrid hall = test::drawn_hall();
  const Pose2 local_from_map{0.7, -1.3, 0.5};
  const OccupancyGrid local = test::moved_grid(test::part_of(hall, 0.1, 0.8), local_from_map, 0.1);
  const mapping::merge::LocalCells cells{local};
  const mapping::merge::CellMotion truth = mapping::merge::cell_motion(inverse(local_from_map), hall.geometry(), cells);
};

TEST_F(Shifts, AreBestWhereTheMapsAgree) {
  expect_truth(correlation(1, 1000).best_shifts(truth.turn_rad, 1).front(), 1.0);
}

TEST_F(Shifts, AreFoundAfterHalfATurnToo) {
  expect_truth(correlation(1, 1000).best_shifts(truth.turn_rad - std::numbers::pi, 1).back(), 1.5);
}

TEST_F(Shifts, AreFoundInShrunkenPicturesAsFarAsAPixelTells) {
  const ShiftCorrelation shrunken = correlation(1, 100);
  ASSERT_GT(shrunken.cells_per_pixel(), 1);
  expect_truth(shrunken.best_shifts(truth.turn_rad, 1).front(), shrunken.cells_per_pixel());
  EXPECT_EQ(correlation(7, 1000).cells_per_pixel(), 7);
}

}  // namespace
}  // namespace deltamap::surveying::grid_registration
