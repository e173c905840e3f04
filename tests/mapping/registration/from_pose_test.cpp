// SPDX-License-Identifier: Apache-2.0
#include "mapping/registration/from_pose.hpp"

#include <gtest/gtest.h>

namespace deltamap::mapping::registration {
namespace {

TEST(FromPose, AddsItsFloorToTheCovarianceOfThePose) {
  PoseCovariance told = PoseCovariance::Zero();
  told(0, 0) = 0.01;
  told(0, 1) = told(1, 0) = 0.002;
  const PoseCovariance found = floored(told, {.least_position_deviation_m = 0.2, .least_heading_deviation_rad = 0.1});
  EXPECT_DOUBLE_EQ(found(0, 0), 0.05);
  EXPECT_DOUBLE_EQ(found(1, 1), 0.04);
  EXPECT_DOUBLE_EQ(found(2, 2), 0.01);
  EXPECT_EQ(found(0, 1), told(0, 1));
}

TEST(FromPose, CountsManyPointsAsNoMoreThanTheIndependentOnes) {
  const FromPoseParams params{.surface_deviation_m = 0.04, .independent_points = 60.0};
  EXPECT_EQ(share_of_point(0, params), 1.0);
  EXPECT_EQ(share_of_point(60, params), 1.0);
  EXPECT_EQ(share_of_point(240, params), 0.25);
  EXPECT_DOUBLE_EQ(registration_params(60, 0.05, params).point_deviation_m, 0.04);
  EXPECT_DOUBLE_EQ(registration_params(240, 0.05, params).point_deviation_m, 0.08);
}

TEST(FromPose, EndsAtTwoCellsButNeverBeyondTheReach) {
  const FromPoseParams params{.reach_m = 0.3};
  EXPECT_EQ(registration_params(60, 0.05, params).first_reach_m, 0.3);
  EXPECT_EQ(registration_params(60, 0.05, params).last_reach_m, 0.12) << "of small cells more than two";
  EXPECT_EQ(registration_params(60, 0.1, params).last_reach_m, 0.2);
  EXPECT_EQ(registration_params(60, 0.25, params).last_reach_m, 0.3);
}

}  // namespace
}  // namespace deltamap::mapping::registration
