// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/span.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace deltamap::mapping::things {
namespace {

constexpr double kQuarter_rad = std::numbers::pi / 2;
const Outline kUpright{{3.0, 5.0}, 2.4, 1.0, kQuarter_rad, {true, false, false, false}, {}};

TEST(Span, OfAnOutlineReachesAlongTheAxesOfAnother) {
  const Span span = span_of(kUpright, {2.0, 5.0, 0.0});
  EXPECT_NEAR(span.low[0], 0.5, 1e-9);
  EXPECT_NEAR(span.high[0], 1.5, 1e-9);
  EXPECT_NEAR(span.extent(1), 2.4, 1e-9);
  EXPECT_NEAR(span.middle(0), 1.0, 1e-9);
  EXPECT_TRUE(span.has({1.0, 1.1}));
  EXPECT_FALSE(span.has({1.0, 1.3}));
}

TEST(Span, BecomesAnOutlineThatLiesAlongItsLongerSide) {
  const Outline same = outline_of(span_of(kUpright, {2.0, 5.0, 0.0}), {2.0, 5.0, 0.0}, {false, true, false, false});
  EXPECT_NEAR((same.centre - kUpright.centre).norm(), 0.0, 1e-9);
  EXPECT_NEAR(same.length_m, 2.4, 1e-9);
  EXPECT_NEAR(same.width_m, 1.0, 1e-9);
  EXPECT_NEAR(same.heading_rad, kQuarter_rad, 1e-9);
  EXPECT_EQ(same.seen, kUpright.seen) << "the northern side";
}

TEST(Span, KeepsItsSidesWhereTheHeadingTurnsRound) {
  const Pose2 axes{0.0, 0.0, 1.2 * kQuarter_rad};  // x to the north-west
  const Outline outline = outline_of({{-0.5, -1.0}, {0.5, 1.0}}, axes, {true, false, false, false});
  EXPECT_GE(outline.heading_rad, 0.0);
  EXPECT_LT(outline.heading_rad, std::numbers::pi);
  const auto corner = corners(outline);
  std::size_t side = 0;
  while (!outline.seen[side]) ++side;
  const Point2 middle = 0.5 * (corner[side] + corner[(side + 1) % 4]);
  EXPECT_NEAR((middle - axes * Point2{0.5, 0.0}).norm(), 0.0, 1e-9);
}

TEST(Span, OutlinesAreParallelWhicheverSideIsTheLonger) {
  Outline other = kUpright;
  other.heading_rad = 0.1;
  EXPECT_TRUE(are_parallel(kUpright, other));
  other.heading_rad = 0.4;
  EXPECT_FALSE(are_parallel(kUpright, other));
}

}  // namespace
}  // namespace deltamap::mapping::things
