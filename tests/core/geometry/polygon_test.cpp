// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/polygon.hpp"

#include <gtest/gtest.h>

namespace deltamap {
namespace {

const Polygon kSquare{{0.0, 0.0}, {2.0, 0.0}, {2.0, 2.0}, {0.0, 2.0}};
const Polygon kAngle{{0.0, 0.0}, {3.0, 0.0}, {3.0, 1.0}, {1.0, 1.0}, {1.0, 3.0}, {0.0, 3.0}};

TEST(Polygon, HasAnAreaWhicheverWayRoundItIsDrawn) {
  EXPECT_DOUBLE_EQ(area_m2(kSquare), 4.0);
  EXPECT_DOUBLE_EQ(area_m2({kAngle.rbegin(), kAngle.rend()}), 5.0);
}

TEST(Polygon, TellsInsideFromOutsideInItsBays) {
  EXPECT_TRUE(contains(kAngle, {0.5, 2.5}));
  EXPECT_TRUE(contains(kAngle, {2.5, 0.5}));
  EXPECT_FALSE(contains(kAngle, {2.0, 2.0})) << "within its box";
  EXPECT_FALSE(contains(kAngle, {-0.5, 0.5}));
}

TEST(Polygon, NamesTheSidesThatCross) {
  EXPECT_FALSE(crossing_sides(kSquare));
  EXPECT_FALSE(crossing_sides(kAngle));
  EXPECT_EQ(crossing_sides({{0.0, 0.0}, {2.0, 2.0}, {2.0, 0.0}, {0.0, 2.0}}),
            (std::pair<std::size_t, std::size_t>{0, 2}));
  EXPECT_TRUE(crossing_sides({{0.0, 0.0}, {2.0, 0.0}, {1.0, 0.0}})) << "it folds back onto itself";
  EXPECT_TRUE(crossing_sides({{0.0, 0.0}, {4.0, 0.0}, {4.0, 2.0}, {2.0, 0.0}, {0.0, 2.0}})) << "a corner on a side";
  EXPECT_TRUE(crossing_sides({{0.0, 0.0}, {0.0, 0.0}, {1.0, 1.0}})) << "a corner twice";
}

TEST(Polygon, SharesAnAreaOnlyWhereBothCover) {
  const Polygon beside{{2.0, 0.0}, {4.0, 0.0}, {4.0, 2.0}, {2.0, 2.0}};
  EXPECT_DOUBLE_EQ(shared_area_m2(kSquare, beside, 0.05), 0.0) << "one common side";
  const Polygon across{{1.0, 1.0}, {3.0, 1.0}, {3.0, 3.0}, {1.0, 3.0}};
  EXPECT_NEAR(shared_area_m2(kSquare, across, 0.05), 1.0, 0.01);
  EXPECT_NEAR(shared_area_m2(kAngle, kSquare, 0.05), 3.0, 0.01);
}

}  // namespace
}  // namespace deltamap
