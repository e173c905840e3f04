// SPDX-License-Identifier: Apache-2.0
#include "mapping/registration/acceptance.hpp"

#include <gtest/gtest.h>

#include "mapping/registration/contour_score.hpp"
#include "mapping/registration/transformed_grid.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::mapping::registration {
namespace {

using test::drawn_grid;

TEST(Acceptance, CountsByHandAndIgnoresUnknown) {
  const OccupancyGrid one = drawn_grid({"##. ",  //
                                        "..# "});
  const OccupancyGrid other = drawn_grid({"#.. ",  //
                                          ". ##"});
  const Acceptance counts = acceptance(one, other);
  EXPECT_EQ(counts.agreeing, 4U);
  EXPECT_EQ(counts.disagreeing, 1U);
  EXPECT_DOUBLE_EQ(counts.value(), 0.8);
}

TEST(Acceptance, IsZeroWhereNothingAgrees) {
  EXPECT_EQ(acceptance(drawn_grid({"##"}), drawn_grid({"  "})).value(), 0.0);
  EXPECT_EQ(acceptance(drawn_grid({"##"}), drawn_grid({".."})).value(), 0.0);
}

TEST(Acceptance, ReadsAnotherGeometryAtTheCellCentres) {
  const OccupancyGrid one = drawn_grid({"#.", ".."});
  const OccupancyGrid finer = drawn_grid({"##..", "##..", "....", "...."}, 0.5);
  EXPECT_EQ(acceptance(one, finer).agreeing, 4U);
  const OccupancyGrid shifted = drawn_grid({"."}, 1.0, {1.0, 0.0});
  EXPECT_EQ(acceptance(one, shifted).agreeing, 1U);
  EXPECT_EQ(acceptance(one, shifted).disagreeing, 0U);
}

TEST(SurfaceAgreement, CountsOccupiedCellsBesideOccupiedOnes) {
  const OccupancyGrid map = drawn_grid({"#.....", "......", "......"});
  const OccupancyGrid local = drawn_grid({".#....", "....#.", "......"});
  EXPECT_DOUBLE_EQ(surface_agreement(map, local, {}), 0.5);
  EXPECT_DOUBLE_EQ(surface_agreement(map, local, {100.0, 0.0, 0.0}), 0.0);
}

TEST(TransformedGrid, TurnsAndShiftsWholeCells) {
  const OccupancyGrid source = drawn_grid({"#. ",  //
                                           "..."});
  const OccupancyGrid turned = transformed_grid(source, {2.0, 0.0, radians(90.0)}, {2, 3, 1.0, {0.0, 0.0}});
  EXPECT_EQ(turned, drawn_grid({" .", "..", "#."}));
}

TEST(Overridden, KeepsTheMapWhereTheLocalMapIsUnknown) {
  EXPECT_EQ(overridden(drawn_grid({"#.# "}), drawn_grid({".#  "})), drawn_grid({".## "}));
}

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
