// SPDX-License-Identifier: Apache-2.0
// A map that is changed step by step tells the same changes as a comparison of the whole maps.
#include "mapping/redraw/map_draft.hpp"

#include <gtest/gtest.h>

#include <type_traits>

#include "core/random.hpp"

namespace deltamap::mapping::redraw {
namespace {

TEST(MapDraft, TellsWhatAComparisonOfTheWholeMapsTells) {
  Random random{3};
  const OccupancyGrid before{{30, 20, 0.1, {0.0, 0.0}}, CellState::kFree};
  MapDraft draft{before};
  for (int i = 0; i < 300; ++i) {
    const Cell cell{static_cast<int>(random.uniform(0.0, 30.0)), static_cast<int>(random.uniform(0.0, 20.0))};
    draft.set(cell, static_cast<CellState>(i % 3));
  }
  EXPECT_FALSE(draft.changes().empty());
  EXPECT_EQ(draft.changes(), changes_between(before, draft.map()));
}

TEST(MapDraft, IsMadeOfNoMapThatIsGoneByThen) {
  EXPECT_FALSE((std::is_constructible_v<MapDraft, OccupancyGrid>));
  EXPECT_TRUE((std::is_constructible_v<MapDraft, const OccupancyGrid&>));
}

TEST(MapDraft, HasNotChangedACellThatWasSetBack) {
  const OccupancyGrid before{{3, 3, 0.1, {0.0, 0.0}}, CellState::kFree};
  MapDraft draft{before};
  draft.set({1, 1}, CellState::kOccupied);
  EXPECT_EQ(draft.changes().size(), 1U);
  draft.set({1, 1}, CellState::kFree);
  EXPECT_TRUE(draft.changes().empty());
}

}  // namespace
}  // namespace deltamap::mapping::redraw
