// SPDX-License-Identifier: Apache-2.0
#include "mapping/registration/contour_score.hpp"

#include <gtest/gtest.h>

#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::mapping::registration {
namespace {

using test::drawn_grid;

TEST(ContourScore, PairsOneToOneEqualCellsFirst) {
  const OccupancyGrid truth = drawn_grid({"......", "###...", "......"});
  EXPECT_DOUBLE_EQ(contour_score(truth, truth).f1(), 1.0);
  // One row off: all three still pair. A doubled wall: only half of it does.
  EXPECT_DOUBLE_EQ(contour_score(truth, drawn_grid({"###...", "......", "......"})).f1(), 1.0);
  const ContourScore doubled = contour_score(truth, drawn_grid({"###...", "###...", "......"}));
  EXPECT_DOUBLE_EQ(doubled.recall(), 1.0);
  EXPECT_DOUBLE_EQ(doubled.precision(), 0.5);
  EXPECT_DOUBLE_EQ(contour_score(truth, drawn_grid({"......", "....##", "......"})).f1(), 0.0);
}

TEST(ContourScore, ForgivesWallsWhereTheReferenceIsUnknown) {
  const ContourScore score = contour_score(drawn_grid({"#.    "}), drawn_grid({"#...##"}));
  EXPECT_DOUBLE_EQ(score.f1(), 1.0);
}

}  // namespace
}  // namespace deltamap::mapping::registration
