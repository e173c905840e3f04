// SPDX-License-Identifier: Apache-2.0
#include "localization/tracking/odometry_noise.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"

namespace deltamap::localization::tracking {
namespace {

const PoseCovariance kSharpFix = Eigen::Vector3d{1e-6, 1e-6, 1e-7}.asDiagonal();

/// Drives straight on with wheels that err by so much after a metre, while scans fix the pose.
void drive(OdometryNoiseEstimator& wheels, double metre_per_root_metre, double turn_per_root_metre_rad,
           const PoseCovariance& fix) {
  constexpr double kStepM = 0.05;
  Random random{3};
  Pose2 truth;
  for (int i = 0; i < 4000; ++i) {
    const Pose2 driven{kStepM, 0.0, 0.0};
    truth = truth * driven;
    const Pose2 by_wheels{kStepM + random.normal(metre_per_root_metre * std::sqrt(kStepM)), 0.0,
                          random.normal(turn_per_root_metre_rad * std::sqrt(kStepM))};
    wheels.learn(by_wheels, {truth, fix});
  }
}

TEST(OdometryNoiseEstimator, LearnsHowGoodTheWheelsAre) {
  constexpr double kLatitude = 0.35;  // twenty stretches tell no more
  const OdometryNoiseParams params;
  for (const double scale : {0.3, 1.0, 2.0}) {
    OdometryNoiseEstimator wheels{params};
    drive(wheels, scale * params.metre_per_root_metre, scale * params.turn_per_root_metre_rad, kSharpFix);
    EXPECT_NEAR(wheels.distance_scale() / scale, 1.0, kLatitude) << scale;
    EXPECT_NEAR(wheels.turn_scale() / scale, 1.0, kLatitude) << scale;
  }
}

TEST(OdometryNoiseEstimator, LearnsNothingFromFixesThatAreWorseThanTheWheels) {
  OdometryNoiseEstimator wheels{{}};
  drive(wheels, 0.0, 0.0, Eigen::Vector3d{1.0, 1.0, 1.0}.asDiagonal());
  EXPECT_EQ(wheels.distance_scale(), 1.0);
  EXPECT_EQ(wheels.turn_scale(), 1.0);
}

TEST(OdometryNoiseEstimator, AddsErrorWithTheWayAndNoneToARobotThatStands) {
  const OdometryNoiseEstimator wheels{{.metre_per_root_metre = 0.05}};
  EXPECT_EQ(wheels.added({}, 0.7), PoseCovariance::Zero());
  const PoseCovariance north = wheels.added({1.0, 0.0, 0.0}, std::acos(0.0));
  EXPECT_NEAR(north(1, 1), 0.05 * 0.05, 1e-9);
  EXPECT_NEAR(wheels.added({4.0, 0.0, 0.0}, 0.0)(0, 0), 4.0 * 0.05 * 0.05, 1e-9);
}

TEST(OdometryNoiseEstimator, CarriesTheHeadingsErrorIntoThePlaces) {
  const OdometryNoiseEstimator wheels{{}};
  const PoseCovariance start = Eigen::Vector3d{0.0, 0.0, 0.01}.asDiagonal();
  const sensor::RefinedPose there = predicted({{1.0, 1.0, 0.0}, start}, {2.0, 0.0, 0.0}, wheels);
  EXPECT_NEAR(there.map_from_robot.x, 3.0, 1e-12);
  EXPECT_GE(there.covariance(1, 1), 4.0 * 0.01);  // two metres at a tenth of a radian
  EXPECT_GT(there.covariance(1, 2), 0.0);
}

}  // namespace
}  // namespace deltamap::localization::tracking
