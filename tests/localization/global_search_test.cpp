// SPDX-License-Identifier: Apache-2.0
#include "localization/global_search.hpp"

#include <gtest/gtest.h>

#include "tests/support/cast_scan.hpp"

namespace deltamap::localization {
namespace {

/// 10 × 6 m, nowhere the same.
OccupancyGrid flat() {
  OccupancyGrid map{{220, 140, 0.05, {-0.5, -0.5}}};
  test::fill_box(map, {-0.2, -0.2}, {10.2, 6.2}, CellState::kOccupied);
  test::fill_box(map, {0.0, 0.0}, {10.0, 6.0}, CellState::kFree);
  test::fill_box(map, {3.0, 0.0}, {3.2, 4.0}, CellState::kOccupied);
  test::fill_box(map, {6.0, 2.5}, {6.2, 6.0}, CellState::kOccupied);
  test::fill_box(map, {8.0, 1.0}, {8.9, 1.6}, CellState::kOccupied);
  test::fill_box(map, {1.0, 4.8}, {1.5, 6.0}, CellState::kOccupied);
  return map;
}

TEST(GlobalSearch, SpreadsPosesOverFreeCellsOnly) {
  const OccupancyGrid map = flat();
  Random random{3};
  const auto poses = poses_anywhere(map.geometry(), free_cells(map), 5000, random);
  int left = 0;
  for (const Pose2& pose : poses) {
    ASSERT_EQ(map.at(map.geometry().cell_at(pose.position())), CellState::kFree);
    left += pose.x < 3.0 ? 1 : 0;
  }
  EXPECT_NEAR(left / 5000.0, 0.3, 0.02);
}

TEST(GlobalSearch, PutsParticlesWhereTheScanFits) {
  const OccupancyGrid map = flat();
  const LikelihoodField field{map, {}};
  const Pose2 truth{4.5, 2.0, 1.1};
  Random random{3};
  const Scan scan = test::cast_scan(map, truth, {}, {}, random);
  const BeamEnds ends = scoring_ends(scan, deskewed(scan, {}), 0);
  const auto poses = poses_that_fit(field, map, ends, 1000, {1.0, 1.0, 0.0}, {}, random);
  ASSERT_EQ(poses.size(), 1000u);
  int near = 0;
  for (const Pose2& pose : poses) {
    near += distance_between(pose, truth) < 0.4 && std::abs(turn_between(pose.theta, truth.theta)) < 0.2 ? 1 : 0;
  }
  EXPECT_GT(near, 5);
}

TEST(GlobalSearch, KeepsWhatWasBelievedWhereItStillFits) {
  const OccupancyGrid map = flat();
  const LikelihoodField field{map, {}};
  const Pose2 truth{4.5, 2.0, 1.1};
  Random random{3};
  const Scan scan = test::cast_scan(map, truth, {}, {}, random);
  const BeamEnds ends = scoring_ends(scan, deskewed(scan, {}), 0);
  const GlobalSearchParams few{.most_candidates = 1000, .places = 5};
  const auto poses = poses_that_fit(field, map, ends, 200, truth, few, random);
  int near = 0;
  for (const Pose2& pose : poses) near += distance_between(pose, truth) < 0.4 ? 1 : 0;
  EXPECT_GT(near, 40);
}

}  // namespace
}  // namespace deltamap::localization
