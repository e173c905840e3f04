// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/pose_spread.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace deltamap {
namespace {

TEST(PoseSpread, IsAsWideAsTheLongestAxisOfTheEllipse) {
  PoseCovariance covariance = PoseCovariance::Zero();
  covariance(0, 0) = covariance(1, 1) = 0.05;
  covariance(0, 1) = covariance(1, 0) = 0.04;  // turned by 45°: 0.09 along, 0.01 across
  EXPECT_NEAR(widest_deviation_m(covariance), 0.3, 1e-12);
}

TEST(PoseSpread, CountsWhatAPoseIsOffInDeviationsAlongTheAxesOfTheEllipse) {
  PoseCovariance covariance = PoseCovariance::Zero();
  covariance(0, 0) = covariance(1, 1) = 0.05;
  covariance(0, 1) = covariance(1, 0) = 0.04;  // turned by 45°: σ is 0.3 along, 0.1 across
  covariance(2, 2) = 0.01;
  const double along = 0.6 / std::sqrt(2.0);
  EXPECT_NEAR(squared_deviations({along, along, 0.0}, covariance), 4.0, 1e-9);
  EXPECT_NEAR(squared_deviations({along, -along, 0.0}, covariance), 36.0, 1e-9);
  EXPECT_NEAR(squared_deviations({0.0, 0.0, -0.1}, covariance), 1.0, 1e-9);
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
