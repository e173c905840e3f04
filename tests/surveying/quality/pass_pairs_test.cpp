// SPDX-License-Identifier: Apache-2.0
#include "surveying/quality/pass_pairs.hpp"

#include <gtest/gtest.h>

#include "tests/surveying/quality/placed_drive.hpp"

namespace deltamap::surveying::quality {
namespace {

std::vector<PassPair> pairs_of(const test::PlacedDrive& drive) {
  const std::vector<Pass> passes = passes_of(drive.placed);
  return pass_pairs(drive.placed, passes, SeenWalls{drive.placed, passes});
}

const std::vector<Pose2> kThereAndBack = test::way_along({{7.0, 1.0}, {13.0, 1.0}, {7.0, 1.1}});

TEST(PassPairs, AgreeAtTruePoses) {
  const test::PlacedDrive drive{test::drawn_hall(0.02), kThereAndBack};
  const std::vector<PassPair> pairs = pairs_of(drive);
  ASSERT_FALSE(pairs.empty());
  for (const PassPair& pair : pairs) {
    EXPECT_LT(pair.one, pair.other);
    EXPECT_LT(pair.through_share(), 0.1);
  }
}

TEST(PassPairs, TellWhereAndHowFarAPassIsOff) {
  test::PlacedDrive drive{test::drawn_hall(0.02), kThereAndBack};
  const std::vector<Pass> passes = passes_of(drive.placed);
  drive.move(passes.back().first, passes.back().last + 1, {0.0, 0.6, 0.0});
  std::size_t disagreeing = 0;
  for (const PassPair& pair : pairs_of(drive)) {
    if (pair.through_share() <= kMostThrough) continue;
    EXPECT_EQ(pair.other, passes.size() - 1);
    ++disagreeing;
    EXPECT_GT(pair.depth_m, 0.4);
    EXPECT_GT(pair.place.x(), -1.0);
    EXPECT_LT(pair.place.x(), 21.0);
  }
  EXPECT_GE(disagreeing, 2U);
}

TEST(PassPairs, TakeTheTwoFacesOfAThinWallForTwo) {
  OccupancyGrid rooms{{600, 500, 0.02, {-1.0, -5.0}}, CellState::kFree};
  test::fill(rooms, {0.0, 0.0}, {10.0, 0.16}, CellState::kOccupied);  // seen from either side
  test::fill(rooms, {-0.1, -4.0}, {0.0, 4.0}, CellState::kOccupied);
  const test::PlacedDrive above{rooms, test::way_along({{1.5, 1.5}, {4.0, 1.5}})};
  const test::PlacedDrive below{rooms, test::way_along({{4.0, -1.5}, {1.5, -1.5}})};
  std::vector<PlacedScan> scans = above.placed;
  for (PlacedScan scan : below.placed) {
    scan.drive = 1;
    scans.push_back(scan);
  }
  const std::vector<Pass> passes = passes_of(scans);
  for (const PassPair& pair : pass_pairs(scans, passes, SeenWalls{scans, passes})) EXPECT_LT(pair.through_share(), 0.1);
}

}  // namespace
}  // namespace deltamap::surveying::quality
