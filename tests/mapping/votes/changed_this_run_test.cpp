// SPDX-License-Identifier: Apache-2.0
#include "mapping/votes/changed_this_run.hpp"

#include <gtest/gtest.h>

#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping::votes {
namespace {

const GridGeometry kMap{20, 20, 0.05, {0.0, 0.0}};
constexpr Cell kBlock{2, 3};
constexpr Cell kCell{4, 6};        // in it
constexpr Cell kCellBeside{5, 7};  // in it too

class ChangedThisRunTest : public testing::Test {
 protected:
  void begin() {
    clear = ClearSpace{map, {map.geometry(), 2}};
    changed = ChangedThisRun{clear};
  }
  void write(Cell cell, CellState state) {
    const OccupancyGrid before = map;
    map.set(cell, state);
    const std::vector<CellChange> changes = changes_between(before, map);
    clear.update(map, changes);
    changed.follow(clear, changes);
  }

  OccupancyGrid map{kMap, CellState::kFree};
  ClearSpace clear;
  ChangedThisRun changed;
};

TEST_F(ChangedThisRunTest, IsWhatHasBeenWrittenSinceTheFirstMap) {
  begin();
  EXPECT_FALSE(changed.is_changed_this_run(kBlock));
  write(kCell, CellState::kOccupied);
  EXPECT_TRUE(changed.is_changed_this_run(kBlock));
}

TEST_F(ChangedThisRunTest, IsNothingThatTheFirstMapShows) {
  map.set(kCell, CellState::kOccupied);
  begin();
  write(kCellBeside, CellState::kOccupied);
  EXPECT_FALSE(changed.is_changed_this_run(kBlock));
}

TEST_F(ChangedThisRunTest, IsNothingThatComesWhereTheFirstMapHadSomething) {
  map.set(kCell, CellState::kOccupied);
  begin();
  write(kCell, CellState::kFree);
  write(kCell, CellState::kOccupied);  // a pane, wrapped goods: seen through and met again
  EXPECT_FALSE(changed.is_changed_this_run(kBlock));
}

TEST_F(ChangedThisRunTest, IsNothingThatHasGone) {
  begin();
  write(kCell, CellState::kOccupied);
  write(kCellBeside, CellState::kOccupied);
  write(kCell, CellState::kUnknown);
  EXPECT_TRUE(changed.is_changed_this_run(kBlock));
  write(kCellBeside, CellState::kFree);
  EXPECT_FALSE(changed.is_changed_this_run(kBlock));
}

}  // namespace
}  // namespace deltamap::mapping::votes
