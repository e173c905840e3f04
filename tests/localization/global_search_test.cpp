// SPDX-License-Identifier: Apache-2.0
#include "localization/global_search.hpp"

#include <gtest/gtest.h>

#include "tests/support/cast_scan.hpp"
#include "tests/support/drawn_flat.hpp"

namespace deltamap::localization {
namespace {

TEST(GlobalSearch, SpreadsPosesOverFreeCellsOnly) {
  const OccupancyGrid map = test::drawn_flat();
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
  const OccupancyGrid map = test::drawn_flat();
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
  const OccupancyGrid map = test::drawn_flat();
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
