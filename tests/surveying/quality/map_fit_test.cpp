// SPDX-License-Identifier: Apache-2.0
#include "surveying/quality/map_fit.hpp"

#include <gtest/gtest.h>

#include "tests/surveying/quality/placed_drive.hpp"

namespace deltamap::surveying::quality {
namespace {

TEST(MapFit, ExplainsTheScansOfATrueMap) {
  const test::PlacedDrive drive{test::drawn_hall(0.02), test::rounds_of_the_hall(1)};
  const MapFit fit = map_fit(test::drawn_hall(0.05), drive.placed);
  EXPECT_GT(fit.explained_share, 0.98);
  EXPECT_EQ(fit.unfit, 0U);
  EXPECT_FALSE(fit.worst);
}

TEST(MapFit, NamesWhereScansDoNotFit) {
  test::PlacedDrive drive{test::drawn_hall(0.02), test::rounds_of_the_hall(1)};
  drive.move(20, 30, {0.7, 0.5, 0.0});
  const MapFit fit = map_fit(test::drawn_hall(0.05), drive.placed);
  EXPECT_GE(fit.unfit, 8U);
  EXPECT_LE(fit.unfit, 10U);
  ASSERT_TRUE(fit.worst);
  EXPECT_NEAR(fit.worst->y(), 1.7, 0.01);
}

}  // namespace
}  // namespace deltamap::surveying::quality
