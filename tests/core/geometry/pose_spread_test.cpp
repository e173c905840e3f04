// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/pose_spread.hpp"

#include <gtest/gtest.h>

namespace deltamap {
namespace {

TEST(PoseSpread, IsAsWideAsTheLongestAxisOfTheEllipse) {
  PoseCovariance covariance = PoseCovariance::Zero();
  covariance(0, 0) = covariance(1, 1) = 0.05;
  covariance(0, 1) = covariance(1, 0) = 0.04;  // turned by 45°: 0.09 along, 0.01 across
  EXPECT_NEAR(widest_deviation_m(covariance), 0.3, 1e-12);
}

TEST(PoseSpread, OfAPoseThatCallsItselfExactKeepsAFloor) {
  const PoseDeviation deviation = pose_deviation(PoseCovariance::Zero());
  EXPECT_DOUBLE_EQ(deviation.position_m, 0.01);
  EXPECT_DOUBLE_EQ(deviation.heading_rad, 0.004);
}

TEST(PoseSpread, LeavesABeamTheMoreRoomAsideTheFartherItGoes) {
  const PoseDeviation deviation{.position_m = 0.03, .heading_rad = 0.01};
  EXPECT_DOUBLE_EQ(deviation.aside_m(0.0), 0.03);
  EXPECT_NEAR(deviation.aside_m(4.0), 0.05, 1e-12);
}

TEST(PoseSpread, ExpectsARangeWithinTwoDeviationsOfPoseAndLaser) {
  EXPECT_NEAR(expected_within_m(0.03, 0.04), 0.1, 1e-12);
}

}  // namespace
}  // namespace deltamap
