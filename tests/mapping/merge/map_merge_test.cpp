// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/map_merge.hpp"

#include <gtest/gtest.h>

#include "tests/support/merge/merge_tally.hpp"
#include "tests/support/worlds/recorded_map.hpp"

namespace deltamap::mapping::merge {
namespace {

auto merging_onto(const OccupancyGrid& map, MergeMethod method) {
  return [&map, method](const OccupancyGrid& local) {
    MapMergeParams params;
    params.method = method;
    return map_merge(map, local, params);
  };
}

/// A small version of Table 1 over continuous angles: two parts of the paper's hall that share two thirds.
TEST(MapMerge, RecoversContinuousTurnsAndShiftsOfTheHall) {
  const OccupancyGrid hall = test::drawn_warehouse(1);
  const OccupancyGrid map = test::moved_grid(test::part_of(hall, 0.0, 0.75), {}, 0.1);
  const OccupancyGrid other = test::part_of(hall, 0.25, 1.0);
  const char* const more = std::getenv("DELTAMAP_MERGE_TRIALS");
  const int trials = more != nullptr ? std::atoi(more) : 12;
  const auto run = [&](const char* name, MergeMethod method) {
    const test::MergeTally tally = test::tally_of(merging_onto(map, method), other, 0.1, trials, 7);
    test::print(name, tally);
    EXPECT_GE(tally.right, 0.96 * trials) << name;
    EXPECT_EQ(tally.wrong_accepted, 0) << name;
    EXPECT_GE(tally.acceptance, 0.99) << name;
    return tally;
  };
  const test::MergeTally ma1 = run("MA1", MergeMethod::kMa1);
  EXPECT_GE(run("MA2", MergeMethod::kMa2).acceptance, ma1.acceptance);
  EXPECT_GE(run("MA3", MergeMethod::kMa3).acceptance, ma1.acceptance);
  EXPECT_GE(run("MA4", MergeMethod::kMa4).acceptance, ma1.acceptance);
}

TEST(MapMerge, RecoversTurnsOfARecordedMap) {
  const auto freiburg = test::recorded_map("freiburg");
  if (!freiburg) GTEST_SKIP() << "DELTAMAP_DATA holds no freiburg map: the merge was NOT tested on a real map";
  const test::MergeTally tally = test::tally_of(merging_onto(*freiburg, MergeMethod::kMa2), *freiburg, 0.1, 20, 8);
  test::print("MA2 freiburg", tally);
  EXPECT_GE(tally.right, 19);
  EXPECT_EQ(tally.wrong_accepted, 0);
}

TEST(MapMerge, RefusesAHallThatLooksTheSameAfterHalfATurn) {
  OccupancyGrid hall{{120, 100, 0.1, {0.0, 0.0}}};
  test::fill(hall, {0.9, 0.9}, {11.1, 9.1}, CellState::kOccupied);
  test::fill(hall, {1.0, 1.0}, {11.0, 9.0}, CellState::kFree);
  test::fill(hall, {3.0, 3.0}, {4.0, 4.5}, CellState::kOccupied);
  test::fill(hall, {8.0, 5.5}, {9.0, 7.0}, CellState::kOccupied);
  EXPECT_EQ(map_merge(hall, hall, {}).refusal, MergeRefusal::kAmbiguous);
  MapMergeParams as_published;
  as_published.choice.refuse_ambiguous = false;
  EXPECT_TRUE(map_merge(hall, hall, as_published).accepted());
}

TEST(MapMerge, RefusesMapsOfDifferentPlaces) {
  const OccupancyGrid hall = test::drawn_hall();
  OccupancyGrid other{{100, 100, 0.1, {0.0, 0.0}}, CellState::kFree};
  Random random{3};
  for (int i = 0; i < 400; ++i) {
    other.set({static_cast<int>(random.index_below(100)), static_cast<int>(random.index_below(100))},
              CellState::kOccupied);
  }
  EXPECT_EQ(map_merge(hall, other, {}).refusal, MergeRefusal::kLowAgreement);
}

TEST(MapMerge, RefusesAMapWithoutSurface) {
  const OccupancyGrid hall = test::drawn_hall();
  EXPECT_EQ(map_merge(hall, OccupancyGrid{hall.geometry(), CellState::kFree}, {}).refusal, MergeRefusal::kTooFewPoints);
  EXPECT_EQ(map_merge(OccupancyGrid{hall.geometry()}, hall, {}).refusal, MergeRefusal::kLowAgreement);
}

}  // namespace
}  // namespace deltamap::mapping::merge
