// SPDX-License-Identifier: Apache-2.0
// Points brought onto one wall, or onto two that meet in a corner.
#include "mapping/registration/registration.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace deltamap::mapping::registration {
namespace {

const Pose2 kTruth{1.0, 1.2, 0.3};

/// Along y = 0, and along x = 0 where there is a corner.
std::vector<SurfacePoint> walls(bool with_corner, double step_m) {
  std::vector<SurfacePoint> points;
  for (double along_m = 0.1; along_m < 4.0; along_m += step_m) {
    points.push_back({{along_m, 0.0}, {0.0, 1.0}});
    if (with_corner) points.push_back({{0.0, along_m}, {1.0, 0.0}});
  }
  return points;
}

NearestSurface surface(bool with_corner) { return {walls(with_corner, 0.01), 0.02, 0.5}; }

/// The same walls as a robot at the truth sees them.
std::vector<Point2> seen(bool with_corner) {
  std::vector<Point2> points;
  for (const SurfacePoint& point : walls(with_corner, 0.05)) points.push_back(inverse(kTruth) * point.position);
  return points;
}

TEST(Registration, BringsPointsOntoACorner) {
  constexpr double kNear = 0.002;
  const Pose2 initial{kTruth.x + 0.1, kTruth.y - 0.08, kTruth.theta + 0.03};
  const Registration found = registration(seen(true), surface(true), initial, {}, {});
  EXPECT_TRUE(found.settled);
  EXPECT_EQ(found.paired, seen(true).size());
  EXPECT_NEAR(found.reference_from_moving.x, kTruth.x, kNear);
  EXPECT_NEAR(found.reference_from_moving.y, kTruth.y, kNear);
  EXPECT_NEAR(found.reference_from_moving.theta, kTruth.theta, kNear);
  EXPECT_LT(found.deviation_m, kNear);
}

TEST(Registration, LeavesTheWayAlongAWallAsItWas) {
  const Pose2 initial{kTruth.x + 0.1, kTruth.y - 0.08, kTruth.theta};
  const Registration found = registration(seen(false), surface(false), initial, {}, {});
  EXPECT_TRUE(found.settled);
  EXPECT_NEAR(found.reference_from_moving.x, initial.x, 1e-3);
  EXPECT_NEAR(found.reference_from_moving.y, kTruth.y, 2e-3);
  EXPECT_LT(found.information(0, 0), 1e-6 * found.information(1, 1));
}

TEST(Registration, TakesFromThePriorWhatTheWallDoesNotTell) {
  const PoseBelief prior{{kTruth.x + 0.2, kTruth.y + 0.2, 0.0}, Eigen::Vector3d{1e4, 1.0, 0.0}.asDiagonal()};
  const Registration found = registration(seen(false), surface(false), kTruth, prior, {});
  EXPECT_NEAR(found.reference_from_moving.x, prior.pose.x, 2e-3);
  EXPECT_NEAR(found.reference_from_moving.y, kTruth.y, 2e-3) << "the wall tells far more";
}

TEST(Registration, StaysUnsettledWhereNothingIsInReach) {
  const Pose2 far{kTruth.x, kTruth.y + 3.0, kTruth.theta};
  const Registration found = registration(seen(false), surface(false), far, {}, {});
  EXPECT_FALSE(found.settled);
  EXPECT_EQ(found.reference_from_moving, far);
}

}  // namespace
}  // namespace deltamap::mapping::registration
