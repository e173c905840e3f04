// SPDX-License-Identifier: Apache-2.0
#include "surveying/grid_registration/global_merge.hpp"

#include <gtest/gtest.h>

#include "tests/support/merge/merge_tally.hpp"
#include "tests/support/worlds/recorded_map.hpp"

namespace deltamap::surveying::grid_registration {
namespace {

auto merging_onto(const OccupancyGrid& map) {
  return [&map](const OccupancyGrid& local) { return global_merge(map, local); };
}

int trials_or(int fewer) {
  const char* const more = std::getenv("DELTAMAP_MERGE_TRIALS");
  return more != nullptr ? std::atoi(more) : fewer;
}

TEST(GlobalMerge, RecoversTurnsAndShiftsToAFractionOfACell) {
  for (const std::uint64_t layout : {1U, 2U}) {
    const OccupancyGrid hall = test::drawn_warehouse(layout);
    const OccupancyGrid map = test::moved_grid(test::part_of(hall, 0.0, 0.75), {}, 0.1);
    const int trials = trials_or(8);
    const auto tally = test::tally_of(merging_onto(map), test::part_of(hall, 0.25, 1.0), 0.1, trials, 9);
    test::print("global hall", tally);
    EXPECT_EQ(tally.wrong_accepted, 0);
    EXPECT_GE(tally.right, 0.96 * trials);
    EXPECT_GE(tally.acceptance, 0.9995);
    EXPECT_LE(tally.error_cells, 0.05);
  }
}

TEST(GlobalMerge, RecoversTurnsOfARecordedMap) {
  const auto freiburg = test::recorded_map("freiburg");
  if (!freiburg) GTEST_SKIP() << "DELTAMAP_DATA holds no freiburg map: the merge was NOT tested on a real map";
  const int trials = trials_or(10);
  const auto tally = test::tally_of(merging_onto(*freiburg), *freiburg, 0.1, trials, 10);
  test::print("global freiburg", tally);
  EXPECT_EQ(tally.wrong_accepted, 0);
  EXPECT_GE(tally.right, 0.96 * trials);
}

TEST(GlobalMerge, RefusesAPeriodicHall) {
  OccupancyGrid hall{{300, 100, 0.1, {0.0, 0.0}}, CellState::kFree};
  for (double x = 1.0; x < 29.0; x += 3.0) test::fill(hall, {x, 2.0}, {x + 1.2, 5.0}, CellState::kOccupied);
  const OccupancyGrid part = test::part_of(hall, 0.3, 0.65);
  EXPECT_EQ(global_merge(hall, part).refusal, mapping::merge::MergeRefusal::kAmbiguous);
}

TEST(GlobalMerge, RefusesMapsWithoutSurfaceAndOfOtherPlaces) {
  const OccupancyGrid hall = test::drawn_hall();
  EXPECT_EQ(global_merge(hall, OccupancyGrid{hall.geometry(), CellState::kFree}).refusal,
            mapping::merge::MergeRefusal::kTooFewPoints);
  EXPECT_EQ(global_merge(OccupancyGrid{hall.geometry()}, hall).refusal, mapping::merge::MergeRefusal::kLowAgreement);
  OccupancyGrid other{{100, 100, 0.1, {0.0, 0.0}}, CellState::kFree};
  Random random{3};
  for (int i = 0; i < 400; ++i) {
    other.set({static_cast<int>(random.index_below(100)), static_cast<int>(random.index_below(100))},
              CellState::kOccupied);
  }
  EXPECT_EQ(global_merge(hall, other).refusal, mapping::merge::MergeRefusal::kLowAgreement);
}

}  // namespace
}  // namespace deltamap::surveying::grid_registration
