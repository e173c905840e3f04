// SPDX-License-Identifier: Apache-2.0
#include "mapping/redraw/enclosed_free_space.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::mapping::redraw {
namespace {

const OccupancyGrid& closed_box() {
  static const OccupancyGrid grid = test::drawn_grid({
      "............",  //
      "...#####....",  //
      "...#...#....",  //
      "...#...#....",  //
      "...#...#....",  //
      "...#####....",  //
      "............",  //
  });
  return grid;
}

TEST(HiddenFloor, IsTheInsideOfWhatIsClosed) {
  const std::vector<Cell> starts{{4, 3}, {2, 3}};
  const std::vector<Point2> robot{{0.5, 0.5}};
  const std::vector<Cell> hidden = enclosed_free_space(closed_box(), starts, robot, 40.0);
  EXPECT_EQ(hidden.size(), 9U);
  for (const Cell& cell : hidden) EXPECT_TRUE(cell.column > 3 && cell.column < 7 && cell.row > 1 && cell.row < 5);
}

TEST(HiddenFloor, IsNotWhereTheRobotWas) {
  const std::vector<Cell> starts{{4, 3}};
  EXPECT_TRUE(enclosed_free_space(closed_box(), starts, std::vector<Point2>{{5.5, 3.5}}, 40.0).empty());
}

TEST(HiddenFloor, IsNotMoreThanWasAllowed) {
  const std::vector<Cell> starts{{4, 3}};
  const std::vector<Point2> robot{{0.5, 0.5}};
  EXPECT_TRUE(enclosed_free_space(closed_box(), starts, robot, 4.0).empty());
}

TEST(HiddenFloor, DoesNotLeakThroughACrack) {
  OccupancyGrid cracked = closed_box();
  cracked.set({3, 3}, CellState::kFree);
  const std::vector<Cell> starts{{4, 3}};
  const std::vector<Point2> robot{{0.5, 0.5}};
  EXPECT_EQ(enclosed_free_space(cracked, starts, robot, 40.0).size(), 10U);  // the crack itself too
}

/// A box of 40 × 40 cells of 5 cm in a field of 80 × 80, its corners left out for so many cells each way.
OccupancyGrid box_without_corners(int left_out) {
  OccupancyGrid grid{{80, 80, 0.05, {0.0, 0.0}}, CellState::kFree};
  for (int i = 20 + left_out; i <= 60 - left_out; ++i) {
    for (const Cell& cell : {Cell{i, 20}, Cell{i, 60}, Cell{20, i}, Cell{60, i}}) grid.set(cell, CellState::kOccupied);
  }
  return grid;
}

TEST(HiddenFloor, DoesNotLeakThroughCornersThatNoBeamHasMet) {
  const std::vector<Cell> starts{{40, 21}};
  const std::vector<Point2> robot{{0.5, 0.5}};
  const std::vector<Cell> hidden = enclosed_free_space(box_without_corners(3), starts, robot, 40.0);
  EXPECT_GE(hidden.size(), 39U * 39U - 4U);  // into the corners, but for their last cells
  EXPECT_LE(hidden.size(), 41U * 41U);
  EXPECT_TRUE(enclosed_free_space(box_without_corners(8), starts, robot, 40.0).empty()) << "0.5 m are a way in";
}

TEST(HiddenFloor, IsOpenThroughAWideGap) {
  OccupancyGrid open = closed_box();
  for (int row = 2; row <= 4; ++row) open.set({3, row}, CellState::kFree);
  const std::vector<Cell> starts{{5, 3}};
  const std::vector<Point2> robot{{0.5, 0.5}};
  EXPECT_TRUE(enclosed_free_space(open, starts, robot, 40.0).empty());
}

TEST(HiddenFloor, OutsideTheMapAndOnSurfacesThereIsNone) {
  const std::vector<Cell> starts{{-1, 3}, {100, 100}, {3, 3}};
  EXPECT_TRUE(enclosed_free_space(closed_box(), starts, std::vector<Point2>{{0.5, 0.5}}, 40.0).empty());
}

}  // namespace
}  // namespace deltamap::mapping::redraw
