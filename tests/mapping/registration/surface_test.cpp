// SPDX-License-Identifier: Apache-2.0
// The table that answers the nearest surface point, and places where there is none.
#include "mapping/registration/surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace deltamap::mapping::registration {
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

TEST(Surface, HasTheNormalOfItsLineInEveryDirection) {
  for (int degrees = 0; degrees < 180; degrees += 5) {
    const double along_rad = degrees * std::numbers::pi / 180.0;
    const Point2 along{std::cos(along_rad), std::sin(along_rad)};
    std::vector<Point2> ends;
    for (int i = 0; i < 5; ++i) ends.push_back(Point2{3.0, 4.0} + 0.05 * i * along);
    const std::vector<SurfacePoint> surface = surface_of(ends);
    ASSERT_EQ(surface.size(), ends.size()) << degrees;
    for (const SurfacePoint& point : surface) {
      EXPECT_NEAR(point.normal.dot(along), 0.0, 1e-6) << degrees;
      EXPECT_NEAR(point.normal.norm(), 1.0, 1e-9) << degrees;
    }
  }
}

}  // namespace
}  // namespace deltamap::mapping::registration
