// SPDX-License-Identifier: Apache-2.0
#include "mapping/registration/transformed_grid.hpp"

#include <gtest/gtest.h>

#include "core/geometry/angle.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::mapping::registration {
namespace {

using test::drawn_grid;

TEST(TransformedGrid, TurnsAndShiftsWholeCells) {
  const OccupancyGrid source = drawn_grid({"#. ",  //
                                           "..."});
  const OccupancyGrid turned = transformed_grid(source, {2.0, 0.0, radians(90.0)}, {2, 3, 1.0, {0.0, 0.0}});
  EXPECT_EQ(turned, drawn_grid({" .", "..", "#."}));
}

TEST(Overridden, KeepsTheMapWhereTheLocalMapIsUnknown) {
  EXPECT_EQ(overridden(drawn_grid({"#.# "}), drawn_grid({".#  "})), drawn_grid({".## "}));
}

TEST(MovedGrid, HoldsEveryCellOfTheTurnedGrid) {
  const OccupancyGrid source = drawn_grid({"#.#", "..."}, 0.5);
  const OccupancyGrid moved = moved_grid(source, {4.2, -1.3, radians(90.0)}, 0.1);
  EXPECT_EQ(count_of(moved, CellState::kOccupied), 2U * 25U);
  EXPECT_EQ(count_of(moved, CellState::kFree), 4U * 25U);
  EXPECT_EQ(moved.at(moved.geometry().cell_at(Pose2{4.2, -1.3, radians(90.0)} * Point2{0.25, 0.75})),
            CellState::kOccupied);
}

TEST(PartOf, KeepsTheColumnsWhereTheyLie) {
  const OccupancyGrid part = part_of(drawn_grid({"#..#. .."}), 0.25, 0.75);
  EXPECT_EQ(part, drawn_grid({".#. "}, 1.0, {2.0, 0.0}));
}

}  // namespace
}  // namespace deltamap::mapping::registration
