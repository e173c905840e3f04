// SPDX-License-Identifier: Apache-2.0
#include "mapping/gate/operator_cells.hpp"

#include <gtest/gtest.h>

namespace deltamap::mapping::gate {
namespace {

const GridGeometry kMap{100, 80, 0.05, {0.0, 0.0}};

Timestamp at(double time_s) { return timestamp_from_ns(1'000'000'000'000) + duration_from_seconds(time_s); }

ScanSet seen(double from_s, double to_s) {
  ScanSet set;
  set.began = at(from_s);
  set.ended = at(to_s);
  return set;
}

CellChange occupied(int column, int row) { return {{column, row}, CellState::kFree, CellState::kOccupied}; }

class OperatorCellsTest : public testing::Test {
 protected:
  OperatorCellsTest() {
    held.hold(kMap, std::vector{CellChange{{10, 10}, CellState::kOccupied, CellState::kFree}}, at(50.0));
  }

  [[nodiscard]] std::size_t allowed(std::vector<CellChange> changes, const ScanSet& set) const {
    return held.allowed(std::move(changes), set).size();
  }

  OperatorCells held{{.hold_s = 120.0, .margin_cells = 2}};
};

TEST_F(OperatorCellsTest, WhatWasSeenBeforeNeverWritesThemAgain) {
  EXPECT_EQ(allowed({occupied(10, 10)}, seen(40.0, 49.0)), 0u);
  EXPECT_EQ(allowed({occupied(10, 10)}, seen(49.9, 4000.0)), 0u) << "a later look at an old region";
}

TEST_F(OperatorCellsTest, WhatIsSeenLaterWritesThemOnceItHasLasted) {
  EXPECT_EQ(allowed({occupied(10, 10)}, seen(51.0, 53.0)), 0u);
  EXPECT_EQ(allowed({occupied(10, 10)}, seen(51.0, 169.9)), 0u);
  EXPECT_EQ(allowed({occupied(10, 10)}, seen(51.0, 170.0)), 1u);
}

TEST_F(OperatorCellsTest, HoldsWhatLiesBesideAndNothingElse) {
  const std::vector<CellChange> changes{occupied(12, 8), occupied(13, 10), occupied(10, 13), occupied(90, 70)};
  const auto left = held.allowed(changes, seen(40.0, 49.0));
  EXPECT_EQ(left, (std::vector<CellChange>{changes[1], changes[2], changes[3]}));
}

TEST_F(OperatorCellsTest, EveryWordOfTheOperatorCounts) {
  held.hold(kMap, std::vector{occupied(0, 0), occupied(99, 79)}, at(100.0));
  EXPECT_EQ(allowed({occupied(10, 10), occupied(1, 1), occupied(98, 78)}, seen(60.0, 180.0)), 1u);
}

}  // namespace
}  // namespace deltamap::mapping::gate
