// SPDX-License-Identifier: Apache-2.0
#include "mapping/votes/pose_deviation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace deltamap::mapping::votes {
namespace {

/// A pose of 5 cm and 0.03 rad, of which all scans share `bias_m`.
Estimate estimate_with(double bias_m) {
  Estimate estimate;
  estimate.covariance = PoseCovariance::Zero();
  estimate.bias_covariance = PoseCovariance::Zero();
  for (int i = 0; i < 2; ++i) {
    estimate.covariance(i, i) = 0.05 * 0.05;
    estimate.bias_covariance(i, i) = bias_m * bias_m;
  }
  estimate.covariance(2, 2) = 0.03 * 0.03;
  return estimate;
}

TEST(VotesPoseDeviation, LeavesOutWhatAllScansErrAlike) {
  const PoseDeviation whole = pose_deviation(estimate_with(0.0), 0.0);
  const PoseDeviation own = pose_deviation(estimate_with(0.04), 0.0);
  EXPECT_NEAR(whole.position_m, std::hypot(0.05, 0.01), 1e-9);
  EXPECT_NEAR(own.position_m, std::hypot(0.03, 0.01), 1e-9);
  EXPECT_EQ(whole.heading_rad, own.heading_rad);
}

TEST(VotesPoseDeviation, HeadingErrsByTheScansTimeInATurnEitherWay) {
  const double still_rad = pose_deviation(estimate_with(0.0), 0.0).heading_rad;
  EXPECT_NEAR(pose_deviation(estimate_with(0.0), 0.8).heading_rad, still_rad + 0.008, 1e-12);
  EXPECT_NEAR(pose_deviation(estimate_with(0.0), -0.8).heading_rad, still_rad + 0.008, 1e-12);
}

}  // namespace
}  // namespace deltamap::mapping::votes
