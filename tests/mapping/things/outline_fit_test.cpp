// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/outline_fit.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace deltamap::mapping::things {
namespace {

constexpr double kCell_m = 0.05;
constexpr double kHeading_rad = 0.4;

/// Cells of a grid that lie along a line of the body's own frame, turned and put at (3, 2).
void add_line(BodyCells& cells, const Point2& from, const Point2& to) {
  const Pose2 map_from_body{3.0, 2.0, kHeading_rad};
  const int steps = static_cast<int>((to - from).norm() / kCell_m);
  for (int i = 0; i <= steps; ++i) {
    const Point2 place = map_from_body * Point2{from + (to - from) * (static_cast<double>(i) / steps)};
    cells.faces.push_back(
        {(std::floor(place.x() / kCell_m) + 0.5) * kCell_m, (std::floor(place.y() / kCell_m) + 0.5) * kCell_m});
  }
}

TEST(OutlineFit, TwoFacesOfATurnedBoxGiveItsWholeRectangle) {
  BodyCells cells{{}, {}, kCell_m};
  add_line(cells, {-1.2, -0.8}, {1.2, -0.8});
  add_line(cells, {-1.2, -0.8}, {-1.2, 0.8});
  const Outline outline = outline_of_come(cells);
  EXPECT_NEAR(outline.heading_rad, kHeading_rad, 0.03);
  EXPECT_NEAR(outline.length_m, 2.4, 0.1);
  EXPECT_NEAR(outline.width_m, 1.6, 0.1);
  EXPECT_NEAR((outline.centre - Point2{3.0, 2.0}).norm(), 0.0, 0.1);
  EXPECT_EQ(outline.seen, (std::array<bool, 4>{false, false, true, true}));
}

TEST(OutlineFit, TheHeadingLiesAlongTheLongerSide) {
  BodyCells cells{{}, {}, kCell_m};
  add_line(cells, {-0.4, -1.5}, {-0.4, 1.5});
  add_line(cells, {0.4, -1.5}, {0.4, 1.5});
  const Outline outline = outline_of_come(cells);
  EXPECT_NEAR(outline.heading_rad, kHeading_rad + std::numbers::pi / 2, 0.03);
  EXPECT_NEAR(outline.length_m, 3.0, 0.1);
}

TEST(OutlineFit, OfASingleFaceOneSideIsSeen) {
  BodyCells cells{{}, {}, kCell_m};
  add_line(cells, {-1.0, 0.0}, {1.0, 0.0});
  const Outline outline = outline_of_come(cells);
  EXPECT_LT(outline.width_m, 0.15);
  EXPECT_EQ(outline.seen, (std::array<bool, 4>{false, true, false, false}));
}

TEST(OutlineFit, FloorBeyondTwoFacesTellsHowFarWhatHasGoneReached) {
  const OccupancyGrid map{{120, 120, kCell_m, {0.0, 0.0}}, CellState::kFree};
  BodyCells cells{{}, {}, kCell_m};
  for (int column = 20; column <= 67; ++column) cells.faces.push_back(map.geometry().centre_of({column, 20}));
  for (int row = 21; row <= 31; ++row) cells.faces.push_back(map.geometry().centre_of({20, row}));  // a third of a side
  for (int row = 21; row <= 51; ++row) {
    for (int column = 21; column <= 67; ++column) cells.inside.push_back(map.geometry().centre_of({column, row}));
  }
  const Outline outline = outline_of_gone(cells, map);
  EXPECT_NEAR(outline.length_m, 2.4, 0.1);
  EXPECT_NEAR(outline.width_m, 1.6, 0.1);
}

TEST(OutlineFit, WhatHasGoneReachedUpToTheNeighbourThatHidItsSide) {
  OccupancyGrid map{{120, 120, kCell_m, {0.0, 0.0}}, CellState::kFree};
  for (int row = 40; row <= 60; ++row) map.set({39, row}, CellState::kOccupied);  // a neighbour in the west
  const Outline freed{{2.525, 2.525}, 1.0, 1.0, 0.0, {true, true, true, true}, {}};
  const Outline whole = up_to_neighbours(freed, map);
  EXPECT_NEAR(whole.length_m, 1.05, 0.051);
  EXPECT_GT(whole.length_m, freed.length_m);
  EXPECT_DOUBLE_EQ(whole.width_m, freed.width_m);
  EXPECT_LT(whole.centre.x(), freed.centre.x());

  const Outline face{{2.525, 2.525}, 1.0, 0.1, 0.0, {}, {}};
  EXPECT_EQ(up_to_neighbours(face, map), face) << "nobody knows how deep it was";
}

}  // namespace
}  // namespace deltamap::mapping::things
