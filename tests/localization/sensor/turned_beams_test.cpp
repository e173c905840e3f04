// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/turned_beams.hpp"

#include <gtest/gtest.h>

#include "core/geometry/angle.hpp"

namespace deltamap::localization::sensor {
namespace {

TEST(TurnedBeams, LieInWholeBlocksFromTheRobotsOwn) {
  const motion::BeamEnds ends{{1.0F, 0.1F}, {0.0F, -2.0F}};
  const TurnedBeams ahead = turned_beams(ends, 0.0, 0.25);
  ASSERT_EQ(ahead.count, 2u);
  EXPECT_EQ(ahead.columns[0], 4);
  EXPECT_EQ(ahead.rows[0], 0);
  EXPECT_EQ(ahead.columns[1], 0);
  EXPECT_EQ(ahead.rows[1], -8);
  const TurnedBeams left = turned_beams(ends, radians(90.0), 0.25);
  EXPECT_EQ(left.columns[0], 0);
  EXPECT_EQ(left.rows[0], 4);
  EXPECT_EQ(left.columns[1], 8);
}

TEST(TurnedBeams, AreAFewOfManyEvenlyChosenAndNoneBeyondAnyMap) {
  motion::BeamEnds many;
  for (int i = 0; i < 320; ++i) {
    many.x_m.push_back(static_cast<float>(i));
    many.y_m.push_back(1e9F);
  }
  const TurnedBeams beams = turned_beams(many, 0.0, 1.0);
  ASSERT_EQ(beams.count, TurnedBeams::kMost);
  for (std::size_t i = 0; i < beams.count; ++i) {
    EXPECT_EQ(beams.columns[i], static_cast<int>(10 * i));
    EXPECT_EQ(beams.rows[i], TurnedBeams::kFarthest);
  }
}

}  // namespace
}  // namespace deltamap::localization::sensor
