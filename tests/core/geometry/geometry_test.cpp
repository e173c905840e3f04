// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>

#include "core/geometry/angle.hpp"
#include "core/geometry/pose2.hpp"
#include "core/grid/occupancy_grid.hpp"
#include "core/time.hpp"

namespace deltamap {
namespace {

constexpr double kExact = 1e-12;
constexpr double kPi = std::numbers::pi;

TEST(Angle, WrapsIntoTheHalfOpenCircle) {
  EXPECT_NEAR(wrapped_angle(3.0 * kPi), kPi, kExact);
  EXPECT_NEAR(wrapped_angle(-kPi), kPi, kExact);
  EXPECT_NEAR(wrapped_angle(2.0 * kPi + 0.1), 0.1, kExact);
}

TEST(Angle, TurnsTheShortWay) { EXPECT_NEAR(turn_between(radians(170.0), radians(-170.0)), radians(20.0), kExact); }

/// Run under the undefined-behaviour sanitizer, too: a cast of what no integer holds is caught there.
TEST(GridGeometry, HasACellForEveryPointHoweverWild) {
  const GridGeometry grid{20, 10, 0.05, {-1.0, 2.0}};
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(grid.cell_at({-0.99, 2.06}), (Cell{0, 1}));
  EXPECT_EQ(grid.cell_at({-1.01, 1.99}), (Cell{-1, -1}));
  for (const double wild : {1e300, -1e300, 1e9, -1e9, kInfinity, -kInfinity, kNan}) {
    EXPECT_FALSE(grid.contains(grid.cell_at({wild, 2.06}))) << wild;
    EXPECT_FALSE(grid.contains(grid.cell_at({-0.99, wild}))) << wild;
    const Cell cell = grid.cell_at({wild, wild});
    EXPECT_FALSE(grid.contains({cell.column + 1000, cell.row - 1000})) << wild << ": its neighbours are numbers, too";
  }
}

TEST(Pose2, ComposesAndInverts) {
  const Pose2 a{1.0, 2.0, kPi / 2.0};
  const Point2 ahead = a * Point2{1.0, 0.0};
  EXPECT_NEAR(ahead.x(), 1.0, kExact);
  EXPECT_NEAR(ahead.y(), 3.0, kExact);
  const Pose2 home = a * inverse(a);
  EXPECT_NEAR(home.x, 0.0, kExact);
  EXPECT_NEAR(home.y, 0.0, kExact);
  EXPECT_NEAR(home.theta, 0.0, kExact);
}

TEST(Pose2, SeesAMotionFromItsStart) {
  const Pose2 motion = motion_between({1.0, 1.0, kPi / 2.0}, {1.0, 2.0, kPi});
  EXPECT_NEAR(motion.x, 1.0, kExact);
  EXPECT_NEAR(motion.y, 0.0, kExact);
  EXPECT_NEAR(motion.theta, kPi / 2.0, kExact);
}

TEST(Pose2, InterpolatesItsHeadingTheShortWay) {
  const Pose2 half = interpolated({0.0, 0.0, radians(170.0)}, {2.0, 0.0, radians(-170.0)}, 0.5);
  EXPECT_NEAR(half.x, 1.0, kExact);
  EXPECT_NEAR(std::abs(half.theta), kPi, kExact);
}

TEST(Time, KeepsNanosecondsOfUnixTime) {
  const Timestamp time = timestamp_from_ns(1'700'000'000'123'456'789);
  EXPECT_EQ(unix_ns(time + duration_from_seconds(0.5)), 1'700'000'000'623'456'789);
  EXPECT_DOUBLE_EQ(seconds(Duration{1'500'000'000}), 1.5);
}

}  // namespace
}  // namespace deltamap
