// SPDX-License-Identifier: Apache-2.0
#include "localization/odometer/wheel_lag.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"

namespace deltamap::localization::odometer {
namespace {

Timestamp at_s(double time_s) { return timestamp_from_ns(1'700'000'000'000'000'000) + duration_from_seconds(time_s); }

/// The robot swings from side to side, now slower, now faster.
double heading_at(double time_s) { return 0.8 * std::sin(0.9 * time_s) + 0.4 * std::sin(2.3 * time_s); }

std::optional<double> found(double lag_s, double turned_share, double seconds) {
  motion::OdometryBuffer reports{{}};
  WheelLag lag;
  Random random{11};
  for (double now_s = 0.0; now_s < seconds; now_s += 0.1) {
    Odometry report;
    report.time = at_s(now_s);
    report.odom_from_robot.theta = 0.95 * turned_share * heading_at(now_s - lag_s);
    reports.add(report);
    const double before = turned_share * heading_at(now_s - 0.1) + random.normal(0.002);
    const double after = turned_share * heading_at(now_s) + random.normal(0.002);
    lag.observe(at_s(now_s - 0.1), at_s(now_s), after - before, reports);
  }
  return lag.lag_s();
}

TEST(WheelLag, IsFoundWithinSecondsOfTurning) {
  for (const double lag_s : {-0.16, 0.0, 0.06, 0.3}) {
    const std::optional<double> lag = found(lag_s, 1.0, 12.0);
    ASSERT_TRUE(lag) << lag_s;
    EXPECT_NEAR(*lag, lag_s, 0.01) << lag_s;
  }
}

TEST(WheelLag, IsNotSaidBeforeItIsKnown) {
  EXPECT_FALSE(found(0.1, 1.0, 4.0));
  EXPECT_FALSE(found(0.1, 0.0, 30.0)) << "a robot that never turns";
}

}  // namespace
}  // namespace deltamap::localization::odometer
