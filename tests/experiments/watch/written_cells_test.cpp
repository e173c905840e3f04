// SPDX-License-Identifier: Apache-2.0
// What counts as written wrongly: right is what stands, or does not stand, within the cell that a map's face may be
// off.
#include "experiments/watch/written_cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "simulation/scenario/start_map.hpp"
#include "simulation/score/change_watch.hpp"
#include "tests/support/worlds/block_room.hpp"

namespace deltamap::experiments {
namespace {

namespace score = simulation::score;

/// A map of a room, of which cells are written.
class WrittenRoom {
 public:
  /// A column of three cells and what they become.
  void write(Cell lowest, CellState after, bool is_astray = false) {
    const std::vector<CellChange> changes = changed(lowest, after);
    written.observe({changes, map, is_astray}, truth, standing);
  }
  void withdraw(Cell lowest, CellState after) { written.observe_withdrawal(changed(lowest, after)); }
  [[nodiscard]] double number(const std::string& name) const {
    const auto numbers = written.numbers(truth.seen(), 1.0);
    const auto found =
        std::find_if(numbers.begin(), numbers.end(), [&](const auto& number) { return number.first == name; });
    return found == numbers.end() ? -1.0 : found->second;
  }

  simulation::Scenario scenario = test::block_room();  // its block's left face lies at x = 3, from y = 1 to 2
  OccupancyGrid map = simulation::start_map(scenario, 0.05);
  score::MapTruth truth{scenario, map};
  OccupancyGrid standing = score::drawn_surfaces(scenario.world, map.geometry());
  Cell face = map.geometry().cell_at({3.0, 1.5});
  Cell floor = map.geometry().cell_at({2.0, 1.5});
  WrittenCells written{map.geometry()};

 private:
  std::vector<CellChange> changed(Cell lowest, CellState after) {
    std::vector<CellChange> changes;
    for (int i = 0; i < 3; ++i) {
      const Cell cell{lowest.column, lowest.row + i};
      changes.push_back({cell, map[cell], after});
      map.set(cell, after);
    }
    return changes;
  }
};

TEST(WrittenCells, AFaceDrawnACellBesideIsRightAndTwoCellsBesideIsWrong) {
  WrittenRoom room;
  room.write({room.face.column - 1, room.face.row}, CellState::kOccupied);
  EXPECT_EQ(room.number("precision"), 1.0);
  room.write({room.face.column - 2, room.face.row}, CellState::kOccupied);
  EXPECT_EQ(room.number("things_written"), 2.0);
  EXPECT_EQ(room.number("precision"), 0.5);
}

TEST(WrittenCells, AFaceThatIsFreedIsWronglyFreedUnlessItStandsACellBeside) {
  WrittenRoom torn;
  for (int row = -1; row <= 3; ++row) torn.map.set({torn.face.column, torn.face.row + row}, CellState::kFree);
  for (int row = 0; row < 3; ++row) torn.map.set({torn.face.column, torn.face.row + row}, CellState::kOccupied);
  torn.write(torn.face, CellState::kFree);
  EXPECT_EQ(torn.number("precision"), 0.0);
  EXPECT_EQ(torn.number("cells_wrong"), 1.0);
  WrittenRoom moved;
  for (int row = 0; row < 3; ++row) {
    moved.map.set({moved.face.column - 1, moved.face.row + row}, CellState::kOccupied);
  }
  moved.write(moved.face, CellState::kFree);
  EXPECT_EQ(moved.number("precision"), 1.0);
  EXPECT_EQ(moved.number("cells_wrong"), 0.0);
}

TEST(WrittenCells, WhoStandsThereIsNotWrongAndWhoHasGoneIs) {
  WrittenRoom room;
  for (int row = 0; row < 3; ++row) {
    room.standing.set({room.floor.column, room.floor.row + row}, CellState::kOccupied);
  }
  room.write(room.floor, CellState::kOccupied);
  EXPECT_EQ(room.number("precision"), 1.0);
  EXPECT_EQ(room.number("cells_wrong"), 1.0) << "he is no part of the lasting world";
  room.write({room.floor.column - 10, room.floor.row}, CellState::kOccupied);
  EXPECT_EQ(room.number("precision"), 0.5);
}

TEST(WrittenCells, WhatIsTakenBackIsNeitherDrawnAstrayNorAThing) {
  WrittenRoom room;
  room.write(room.floor, CellState::kOccupied, true);
  EXPECT_EQ(room.number("cells_written_astray"), 3.0);
  room.withdraw(room.floor, CellState::kFree);
  EXPECT_EQ(room.number("cells_written_astray"), 3.0);
  EXPECT_EQ(room.number("cells_withdrawn"), 3.0);
  EXPECT_EQ(room.number("things_written"), 1.0);
  EXPECT_EQ(room.number("revisions"), 2.0);
}

}  // namespace
}  // namespace deltamap::experiments
