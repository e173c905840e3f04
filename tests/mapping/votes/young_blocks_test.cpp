// SPDX-License-Identifier: Apache-2.0
#include "mapping/votes/young_blocks.hpp"

#include <gtest/gtest.h>

#include "tests/support/drawn_hall.hpp"

namespace deltamap::mapping::votes {
namespace {

const GridGeometry kMap{20, 20, 0.05, {0.0, 0.0}};
constexpr Cell kBlock{2, 3};
constexpr Cell kCell{4, 6};        // in it
constexpr Cell kCellBeside{5, 7};  // in it too

class Young : public testing::Test {
 protected:
  void begin() {
    clear = ClearSpace{map, {map.geometry(), 2}};
    young = YoungBlocks{clear};
  }
  void write(Cell cell, CellState state) {
    const OccupancyGrid before = map;
    map.set(cell, state);
    const std::vector<CellChange> changes = changes_between(before, map);
    clear.update(map, changes);
    young.follow(clear, changes);
  }

  OccupancyGrid map{kMap, CellState::kFree};
  ClearSpace clear;
  YoungBlocks young;
};

TEST_F(Young, IsWhatHasBeenWrittenSinceTheFirstMap) {
  begin();
  EXPECT_FALSE(young.is_young(kBlock));
  write(kCell, CellState::kOccupied);
  EXPECT_TRUE(young.is_young(kBlock));
}

TEST_F(Young, IsNothingThatTheFirstMapShows) {
  map.set(kCell, CellState::kOccupied);
  begin();
  write(kCellBeside, CellState::kOccupied);
  EXPECT_FALSE(young.is_young(kBlock));
}

TEST_F(Young, IsNothingThatComesWhereTheFirstMapHadSomething) {
  map.set(kCell, CellState::kOccupied);
  begin();
  write(kCell, CellState::kFree);
  write(kCell, CellState::kOccupied);  // a pane, wrapped goods: seen through and met again
  EXPECT_FALSE(young.is_young(kBlock));
}

TEST_F(Young, IsNothingThatHasGone) {
  begin();
  write(kCell, CellState::kOccupied);
  write(kCellBeside, CellState::kOccupied);
  write(kCell, CellState::kUnknown);
  EXPECT_TRUE(young.is_young(kBlock));
  write(kCellBeside, CellState::kFree);
  EXPECT_FALSE(young.is_young(kBlock));
}

}  // namespace
}  // namespace deltamap::mapping::votes
