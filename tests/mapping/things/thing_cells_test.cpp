// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/thing_cells.hpp"

#include <gtest/gtest.h>

namespace deltamap::mapping::things {
namespace {

TEST(ThingCells, KeepWhatEachCellWasFirst) {
  ThingCells cells;
  cells.own({-3, 500}, CellState::kUnknown);
  cells.own({40, 480}, CellState::kFree);
  cells.own({40, 480}, CellState::kOccupied);
  EXPECT_EQ(cells.count(), 2u);
  EXPECT_EQ(cells.before({-3, 500}), CellState::kUnknown);
  EXPECT_EQ(cells.before({40, 480}), CellState::kFree);
  EXPECT_EQ(cells.before({0, 0}), std::nullopt);
  EXPECT_TRUE(cells.has_within({38, 478}, 2));
  EXPECT_FALSE(cells.has_within({37, 480}, 2));
  cells.drop({40, 480});
  cells.drop({40, 480});
  EXPECT_EQ(cells.count(), 1u);
}

}  // namespace
}  // namespace deltamap::mapping::things
