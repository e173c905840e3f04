// SPDX-License-Identifier: Apache-2.0
// The table that answers the nearest surface point, and places where there is none.
#include "mapping/alignment/surface.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace deltamap::mapping::alignment {
namespace {

const NearestSurface kSurface{{{{1.0, 2.0}, {0.0, 1.0}}}, 0.1, 0.3};

TEST(NearestSurface, AnswersThePointInReach) {
  const SurfacePoint* nearest = kSurface.nearest({1.1, 2.1});
  ASSERT_NE(nearest, nullptr);
  EXPECT_EQ(nearest->position, Point2(1.0, 2.0));
}

TEST(NearestSurface, HasNoAnswerForAPlaceHoweverFarAway) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double away_m : {0.7, 100.0, 1e9, 1e12, 1e300, kNan}) {
    EXPECT_EQ(kSurface.nearest({1.0 + away_m, 2.0}), nullptr) << away_m;
    EXPECT_EQ(kSurface.nearest({1.0 - away_m, 2.0}), nullptr) << away_m;
    EXPECT_EQ(kSurface.nearest({1.0, 2.0 + away_m}), nullptr) << away_m;
    EXPECT_EQ(kSurface.nearest({1.0, 2.0 - away_m}), nullptr) << away_m;
  }
}

}  // namespace
}  // namespace deltamap::mapping::alignment
