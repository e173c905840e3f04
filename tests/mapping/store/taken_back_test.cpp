// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/taken_back.hpp"

#include <gtest/gtest.h>

#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::mapping::store {
namespace {

TEST(TakenBack, LeavesCellsThatHoldSomethingElse) {
  const OccupancyGrid before = test::drawn_grid({"....", "...."});
  const OccupancyGrid after = test::drawn_grid({"##..", "...."});
  const OccupancyGrid today = test::drawn_grid({"# ..", "...#"});
  const auto back = taken_back(today, changes_between(before, after));
  EXPECT_EQ(patched(today, back), test::drawn_grid({". ..", "...#"}));
  EXPECT_EQ(back.size(), 1u);
}

TEST(TakenBack, LeadsToTheFirstMapWhereTheNewestIsTakenBackFirst) {
  const OccupancyGrid first = test::drawn_grid({"...."});
  const OccupancyGrid second = test::drawn_grid({"##.."});
  const OccupancyGrid third = test::drawn_grid({".##."});
  const OccupancyGrid without_newest = patched(third, taken_back(third, changes_between(second, third)));
  EXPECT_EQ(without_newest, second);
  EXPECT_EQ(patched(without_newest, taken_back(without_newest, changes_between(first, second))), first);
}

TEST(TakenBack, IsNothingOfACellThatTheDeltaLeftAsItWas) {
  const OccupancyGrid map = test::drawn_grid({"#"});
  const CellChange none{{0, 0}, CellState::kOccupied, CellState::kOccupied};
  EXPECT_TRUE(taken_back(map, {&none, 1}).empty());
}

}  // namespace
}  // namespace deltamap::mapping::store
