// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/thing.hpp"

#include <gtest/gtest.h>

namespace deltamap::mapping::things {
namespace {

TEST(Thing, OverlapIsOfTheSmallerOne) {
  const Outline large{{0.0, 0.0}, 4.0, 2.0, 0.0, {}};
  EXPECT_NEAR(overlap_share(large, {{0.0, 0.0}, 1.0, 1.0, 0.0, {}}), 1.0, 1e-9);
  EXPECT_NEAR(overlap_share({{2.0, 0.0}, 1.0, 1.0, 0.0, {}}, large), 0.5, 0.05);
  EXPECT_NEAR(overlap_share(large, {{9.0, 0.0}, 1.0, 1.0, 0.0, {}}), 0.0, 1e-9);
}

TEST(Thing, CornersGoRoundItAndLieOnItsRim) {
  const Outline outline{{1.0, 2.0}, 4.0, 2.0, 0.0, {}};
  const std::array<Point2, 4> around = corners(outline);
  EXPECT_EQ(around[0], Point2(3.0, 1.0));
  EXPECT_EQ(around[1], Point2(3.0, 3.0));
  EXPECT_EQ(around[2], Point2(-1.0, 3.0));
  for (const Point2& corner : around) {
    EXPECT_TRUE(is_inside(outline, corner, 0.01));
    EXPECT_FALSE(is_inside(outline, corner, -0.01));
  }
}

TEST(Thing, IsToldInWords) {
  Thing thing;
  thing.at = Outline{{1.0, 2.0}, 2.5, 2.4, 0.0, {}};
  EXPECT_EQ(words_of(thing), "container-like body of 2.5 × 2.4 m appeared at 1.00, 2.00");
  thing.from = Outline{{0.0, 2.0}, 2.5, 2.4, 0.0, {}};
  thing.kind = ThingKind::kMoved;
  EXPECT_EQ(words_of(thing), "container-like body of 2.5 × 2.4 m moved from 0.00, 2.00 to 1.00, 2.00");
  thing.at.reset();
  thing.kind = ThingKind::kGone;
  thing.from->width_m = 0.1;
  EXPECT_EQ(words_of(thing), "face of 2.5 × 0.1 m left 0.00, 2.00");
  thing.kind = ThingKind::kJoined;
  thing.joined_into = 7;
  EXPECT_EQ(words_of(thing), "face of 2.5 × 0.1 m at 0.00, 2.00 is part of thing 7");
}

}  // namespace
}  // namespace deltamap::mapping::things
