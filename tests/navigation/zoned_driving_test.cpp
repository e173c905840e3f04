// SPDX-License-Identifier: Apache-2.0
#include "navigation/zoned_driving.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

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
  EXPECT_GT(points.size(), 100u);
  EXPECT_LT(points.size(), 170u) << "only what lies around the robot";
  for (const Point2& point : points) {
    EXPECT_NEAR(point.y(), -2.0, 1e-6) << "to its right";
    EXPECT_LE(point.norm(), 8.0);
  }
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_LE((points[i] - points[i - 1]).norm(), 0.11);
}

TEST(ZonedDriving, ARobotThatStandsInABlockedZoneMayLeaveIt) {
  EXPECT_TRUE(blocked_borders({kBlocked}, {2.5, 0.0, 0.0}).empty());
  EXPECT_TRUE(blocked_borders({kSlow}, {0.5, 0.0, 0.0}).empty()) << "a limit is no wall";
}

TEST(ZonedDriving, ARobotLeavesABlockedZoneSlowlyAndItIsNamed) {
  const ZonesAround inside = zones_around({kBlocked}, {2.5, 0.0, 0.0}, {});
  EXPECT_EQ(inside.blocked_around, "B");
  EXPECT_DOUBLE_EQ(inside.most_speed_m_per_s, 0.1);
  const ZonesAround outside = zones_around({kBlocked}, {-20.0, 0.0, 0.0}, {});
  EXPECT_TRUE(outside.bind && outside.blocked_around.empty() && outside.blocked_in_robot.empty());
  EXPECT_FALSE(zones_around({}, {}, {}).bind);
}

TEST(ZonedDriving, ARobotCanBrakeToALimitBeforeItHolds) {
  double before = 0.2;
  for (const double x : {0.5, 0.0, -1.0, -3.0, -6.0}) {
    const double limit = speed_limit_m_per_s({kSlow}, {x, 0.0, 0.0});
    const double braking_m = (limit * limit - 0.2 * 0.2) / (2.0 * 0.3);
    EXPECT_NEAR(braking_m, 0.5 - x, 0.11) << x;
    EXPECT_GE(limit, before);
    before = limit;
  }
  EXPECT_FALSE(std::isinf(speed_limit_m_per_s({kSlow}, {-3.0, 1.4, radians(-5.0)}))) << "on an arc it is met aside";
}

TEST(ZonedDriving, ALimitHoldsInItsZoneAndJustBeforeIt) {
  EXPECT_TRUE(std::isinf(speed_limit_m_per_s({kSlow, kBlocked}, {-9.0, 0.0, 0.0})));
  EXPECT_DOUBLE_EQ(speed_limit_m_per_s({kSlow}, {0.7, 0.0, 0.0}), 0.2);
  EXPECT_DOUBLE_EQ(speed_limit_m_per_s({kSlow}, {2.9, 0.0, 0.0}), 0.2);
  EXPECT_TRUE(std::isinf(speed_limit_m_per_s({kSlow}, {0.7, 0.0, radians(180.0)}))) << "it drives away";
}

TEST(ZonedDriving, AZoneFarAwayCostsNoSearchAlongTheWay) {
  const ZonedDrivingParams finely{.step_m = 1e-7};  // 240 million places ahead: seconds, where they are asked for
  const std::clock_t began = std::clock();
  for (const Pose2& robot : {Pose2{-9.5, 0.0, 0.0}, Pose2{0.5, 0.0, radians(180.0)}, Pose2{0.5, -9.0, 0.0}})
    EXPECT_TRUE(std::isinf(speed_limit_m_per_s({kSlow}, robot, finely)));
  EXPECT_LT(static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC, 0.2);
}

}  // namespace
}  // namespace deltamap::navigation
