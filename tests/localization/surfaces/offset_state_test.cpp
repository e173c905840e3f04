// SPDX-License-Identifier: Apache-2.0
// The Gaussian over pose, wheels, mount and offsets.
#include "localization/surfaces/offset_state.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>

#include "core/geometry/angle.hpp"
#include "core/random.hpp"
#include "localization/motion/drive_calibration.hpp"
#include "tests/localization/surfaces/measured_state.hpp"

namespace deltamap::localization::surfaces {
namespace {

TEST(OffsetState, TakesMeasurementsTogetherAsOneAfterTheOther) {
  OffsetState one_by_one;
  one_by_one.start(at_rest(1.0, 2.0, 0.3));
  one_by_one.append(0.1, 0.5, 0.1);
  OffsetState together = one_by_one;
  const RowMeasurement first{{{{{0, 1.0}, {kOffset, -1.0}}}, 2}, 0.05, 0.01};
  const RowMeasurement second{{{{{2, -1.0}, {kOffset + 1, -1.0}}}, 2}, 0.02, 1e-4};
  const std::array both{first, second};
  together.update(both);
  one_by_one.update({&first, 1});
  RowMeasurement then = second;  // what it still adds after the first one
  then.innovation += one_by_one.mean()[2] - 0.3 + one_by_one.mean()[kOffset + 1];
  one_by_one.update({&then, 1});
  EXPECT_TRUE(together.mean().isApprox(one_by_one.mean(), 1e-12));
  EXPECT_TRUE(together.covariance().isApprox(one_by_one.covariance(), 1e-12));
  EXPECT_EQ(together.covariance(), together.covariance().transpose());
}

TEST(OffsetState, TakesAFactorAsTheProductOfGaussians) {
  OffsetState state;
  state.start(at_rest(1.0, 2.0, 0.3));
  state.append(0.1, 0.5, 0.1);
  measure(state, {{{{0, 1.0}, {kOffset, -1.0}}}, 2}, 0.05, 0.01);  // ties pose and offset
  const Eigen::MatrixXd information = state.covariance().inverse();
  const Eigen::VectorXd weighed = information * state.mean();
  Eigen::Matrix2d precision;
  precision << 40.0, 3.0, 3.0, 90.0;
  const Eigen::Vector2d pull{2.0, -1.0};
  state.multiply<2>(kOffset, precision, pull);
  Eigen::MatrixXd expected = information;
  expected.block<2, 2>(kOffset, kOffset) += precision;
  Eigen::VectorXd expected_weighed = weighed;
  expected_weighed.segment<2>(kOffset) += pull;
  EXPECT_LT((state.covariance() - expected.inverse()).norm(), 1e-9);
  EXPECT_LT((state.mean() - expected.inverse() * expected_weighed).norm(), 1e-9);
}

TEST(OffsetState, KeepsThePoseWhenASurfaceIsForgotten) {
  OffsetState state;
  state.start(at_rest(1.0, 2.0, 0.3));
  state.append(0.1, 0.5, 0.1);
  state.append(0.2, 0.5, 0.1);
  measure(state, {{{{0, 1.0}, {kOffset, -1.0}}}, 2}, 0.05, 0.01);
  measure(state, {{{{1, 1.0}, {kOffset + 2, -1.0}}}, 2}, -0.05, 0.01);
  const sensor::RefinedPose before = state.pose();
  const double second_m = state.mean()[kOffset + 2];
  state.remove(0);
  EXPECT_EQ(state.mean().size(), kOffset + 2);
  EXPECT_EQ(state.mean()[kOffset], second_m);
  EXPECT_EQ(state.pose().map_from_robot, before.map_from_robot);
  EXPECT_EQ(state.pose().covariance, before.covariance);
}

TEST(OffsetState, LetsTheMountWorkLooseAndNoFartherThanALaserCan) {
  OffsetState state;
  state.start(at_rest(0.0, 0.0, 0.0));
  measure(state, {{{{OffsetState::kMount, 1.0}}}, 1}, 1.0, 1e-6);
  const double sure_m = state.calibration().mount_deviations.x;
  for (int i = 0; i < 1000; ++i) state.predict({.motion = {0.2, 0.0, 0.0}}, PoseCovariance::Zero());
  EXPECT_LE(state.calibration().mount_error.x, 0.1);
  EXPECT_GT(state.calibration().mount_deviations.x, sure_m + 0.001);
}

/// Wheels that count 1 % too far and turn 2 % too little, a laser that is told 0.4 degrees wrong, and poses as the
/// particles find them, 2 cm and 3 mrad off: for so many metres.
OffsetState after_metres(double metres) {
  OffsetState state;
  state.start(at_rest(0.0, 0.0, 0.0));
  const PoseCovariance noise = Eigen::Vector3d{1e-5, 1e-5, 1e-6}.asDiagonal().toDenseMatrix();
  const PoseCovariance scatter = Eigen::Vector3d{4e-4, 4e-4, 9e-6}.asDiagonal().toDenseMatrix();
  Random random{6};
  Pose2 truth;
  for (int i = 0; i < std::lround(metres / 0.2); ++i) {
    const Pose2 counted{0.2, 0.0, 0.2 * std::sin(0.1 * i)};
    truth = truth * Pose2{0.202, 0.0, 0.98 * counted.theta};
    state.predict({.motion = counted}, noise);
    Pose2 found = truth * Pose2{random.normal(0.02), random.normal(0.02), random.normal(0.003)};
    found.theta += radians(0.4) - state.calibration().mount_error.theta;
    (void)state.update({found, scatter});  // one in thousands is too far off
  }
  return state;
}

TEST(OffsetState, LearnsWheelsAndTheHeadingOfTheMountFromPosesThatWereFoundOtherwise) {
  const motion::DriveCalibration found = after_metres(200.0).calibration();
  EXPECT_NEAR(found.wheels.distance, 0.01, 0.003);
  EXPECT_NEAR(found.wheels.turn, -0.02, 0.006);
  EXPECT_NEAR(found.mount_error.theta, radians(0.4), radians(0.1));
  EXPECT_EQ(found.mount_error.position(), Point2(0.0, 0.0));
}

TEST(OffsetState, StaysSoundHoweverFarTheRobotDrives) {
  const OffsetState state = after_metres(2000.0);
  EXPECT_TRUE(state.is_sound());
  EXPECT_LT((state.covariance() - state.covariance().transpose()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(state.calibration().wheels.distance, 0.01, 0.003);
}

TEST(OffsetState, GoesOnFromWhatAnEarlierRunHasLearnedAndIsALittleLessSure) {
  const motion::DriveCalibration learned = after_metres(200.0).calibration();
  const auto read = motion::calibration_of(motion::numbers_of(learned));
  ASSERT_TRUE(read);
  OffsetState state;
  state.restore(*read);
  state.start(at_rest(0.0, 0.0, 0.0));
  EXPECT_EQ(state.calibration().wheels.turn, learned.wheels.turn);
  EXPECT_EQ(state.calibration().mount_error, learned.mount_error);
  EXPECT_GT(state.calibration().wheel_deviations.turn, learned.wheel_deviations.turn);
  EXPECT_LT(state.calibration().wheel_deviations.turn, 0.02);
  EXPECT_TRUE(state.is_sound());
}

TEST(OffsetState, TakesNoPoseThatIsFarFromWhereItIsExpected) {
  OffsetState state;
  state.start(at_rest(0.0, 0.0, 0.0));
  const Eigen::VectorXd before = state.mean();
  EXPECT_FALSE(state.update(at_rest(1.0, 0.0, 0.0)));
  EXPECT_EQ(state.mean(), before);
}

}  // namespace
}  // namespace deltamap::localization::surfaces
