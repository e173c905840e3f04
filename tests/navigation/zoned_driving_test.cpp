// SPDX-License-Identifier: Apache-2.0
#include "navigation/zoned_driving.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace deltamap::navigation {
namespace {

const Zone kBlocked{
    .id = "B", .kind = ZoneKind::kBlocked, .polygon = {{2.0, -50.0}, {60.0, -50.0}, {60.0, 50.0}, {2.0, 50.0}}};
const Zone kSlow{.id = "S",
                 .kind = ZoneKind::kSpeedLimit,
                 .most_speed_m_per_s = 0.2,
                 .polygon = {{1.0, -1.0}, {3.0, -1.0}, {3.0, 1.0}, {1.0, 1.0}}};

TEST(ZonedDriving, TheBorderOfABlockedZoneStandsBeforeTheRobot) {
  const auto points = blocked_borders({kBlocked}, {0.0, 0.0, radians(90.0)});
  EXPECT_GT(points.size(), 30u);
  EXPECT_LT(points.size(), 60u) << "only what lies around the robot";
  for (const Point2& point : points) {
    EXPECT_NEAR(point.y(), -2.0, 1e-6) << "to its right";
    EXPECT_LE(point.norm(), 3.0);
  }
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_LE((points[i] - points[i - 1]).norm(), 0.11);
}

TEST(ZonedDriving, ARobotThatStandsInABlockedZoneMayLeaveIt) {
  EXPECT_TRUE(blocked_borders({kBlocked}, {2.5, 0.0, 0.0}).empty());
  EXPECT_TRUE(blocked_borders({kSlow}, {0.5, 0.0, 0.0}).empty()) << "a limit is no wall";
}

TEST(ZonedDriving, ALimitHoldsInItsZoneAndJustBeforeIt) {
  EXPECT_TRUE(std::isinf(speed_limit_m_per_s({kSlow, kBlocked}, {0.0, 0.0, 0.0})));
  EXPECT_DOUBLE_EQ(speed_limit_m_per_s({kSlow}, {0.7, 0.0, 0.0}), 0.2);
  EXPECT_DOUBLE_EQ(speed_limit_m_per_s({kSlow}, {2.9, 0.0, 0.0}), 0.2);
  EXPECT_TRUE(std::isinf(speed_limit_m_per_s({kSlow}, {0.7, 0.0, radians(180.0)}))) << "it drives away";
}

}  // namespace
}  // namespace deltamap::navigation
