// SPDX-License-Identifier: Apache-2.0
// The merge of two grids with a prior.
#include "surveying/grid_registration/prior_merge.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"
#include "mapping/merge/overlay_score.hpp"
#include "tests/support/merge/merge_trial.hpp"
#include "tests/support/worlds/drawn_hall.hpp"
#include "tests/surveying/grid_registration/wrong_guess.hpp"

namespace deltamap::surveying::grid_registration {
namespace {

/// Small version of `deltamap-lab merge`: two parts that share two thirds, guesses that the prior allows.
TEST(PriorGridMerge, BringsALocalMapOntoTheMapToATenthOfACell) {
  const OccupancyGrid world = test::drawn_warehouse(3);
  const OccupancyGrid map = test::moved_grid(test::part_of(world, 0.0, 0.75), {}, 0.1);
  const OccupancyGrid other = test::part_of(world, 0.25, 1.0);
  const mapping::merge::OverlayMap overlay{map};
  Random random{6};
  for (int trial = 0; trial < 10; ++trial) {
    const Pose2 local_from_map{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-3.1, 3.1)};
    const OccupancyGrid local = test::moved_grid(other, local_from_map, 0.1);
    const mapping::merge::LocalCells cells{local};
    const Point2 middle = inverse(local_from_map) * cells.middle_in_local();
    const Pose2 by{random.uniform(-0.25, 0.25), random.uniform(-0.25, 0.25), random.uniform(-0.05, 0.05)};
    const Pose2 error = guess_from_map(middle, by.x, by.y, by.theta);
    const Pose2 guess = error * inverse(local_from_map);
    const PriorMerge merge = prior_merge(map, local, guess, covariance_of(0.15, 0.035), {});
    ASSERT_TRUE(merge.accepted()) << trial << ": " << name_of(merge.refusal);
    const Pose2 found = merge.map_from_guess * guess;
    EXPECT_LT((found * cells.middle_in_local() - middle).norm(), 0.1 * 0.1) << trial;
    const auto acceptance_at = [&](const Pose2& pose) {
      return overlay.score(cells, mapping::merge::cell_motion(pose, map.geometry(), cells)).acceptance();
    };
    EXPECT_GT(acceptance_at(found), acceptance_at(inverse(local_from_map)) - 0.001) << trial;
  }
}

TEST(PriorGridMerge, RefusesALocalMapOfAnotherPlace) {
  const OccupancyGrid map = test::moved_grid(test::drawn_warehouse(3), {}, 0.1);
  OccupancyGrid scattered{{200, 200, 0.1, {10.0, 10.0}}, CellState::kFree};
  Random random{7};
  for (int i = 0; i < 800; ++i) {
    scattered.set({static_cast<int>(random.index_below(200)), static_cast<int>(random.index_below(200))},
                  CellState::kOccupied);
  }
  const PriorMerge merge = prior_merge(map, scattered, {}, covariance_of(0.15, 0.035), {});
  EXPECT_EQ(merge.refusal, mapping::merge::MergeRefusal::kLowAgreement);
  EXPECT_EQ(merge.map_from_guess, Pose2{});
}

TEST(PriorGridMerge, RefusesALocalMapWithoutSurface) {
  const OccupancyGrid map = test::drawn_hall();
  const OccupancyGrid floor{{50, 50, 0.1, {0.0, 0.0}}, CellState::kFree};
  EXPECT_EQ(prior_merge(map, floor, {}, covariance_of(0.1, 0.03), {}).refusal,
            mapping::merge::MergeRefusal::kTooFewPoints);
}

}  // namespace
}  // namespace deltamap::surveying::grid_registration
