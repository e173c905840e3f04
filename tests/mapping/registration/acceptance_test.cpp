// SPDX-License-Identifier: Apache-2.0
#include "mapping/registration/acceptance.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace deltamap::mapping::registration
