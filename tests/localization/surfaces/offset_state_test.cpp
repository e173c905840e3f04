// SPDX-License-Identifier: Apache-2.0
// The Gaussian over pose, wheels, mount and offsets, and the switches that settle on it.
#include "localization/surfaces/offset_state.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "core/angle.hpp"
#include "core/random.hpp"
#include "localization/motion/drive_calibration.hpp"
#include "localization/surfaces/surface_switch.hpp"

namespace deltamap::localization::surfaces {
namespace {

sensor::RefinedPose at_rest(double x, double y, double theta) {
  return {{x, y, theta}, Eigen::Vector3d{1e-4, 1e-4, 1e-5}.asDiagonal().toDenseMatrix()};
}

void measure(OffsetState& state, const SparseRow& row, double innovation, double variance) {
  const RowMeasurement measured{row, innovation, variance};
  state.update({&measured, 1});
}

// Of the first surface that is followed.
constexpr Eigen::Index kOffset = OffsetState::kFixed;

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

TEST(DriveCalibration, OfTooFewNumbersOrOfNoneIsRefused) {
  std::array<double, 14> numbers = motion::numbers_of(after_metres(10.0).calibration());
  EXPECT_FALSE(motion::calibration_of(std::span(numbers).first(13)));
  numbers[12] = -0.001;  // a deviation
  EXPECT_FALSE(motion::calibration_of(numbers));
  numbers[12] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(motion::calibration_of(numbers));
}

TEST(OffsetState, TakesNoPoseThatIsFarFromWhereItIsExpected) {
  OffsetState state;
  state.start(at_rest(0.0, 0.0, 0.0));
  const Eigen::VectorXd before = state.mean();
  EXPECT_FALSE(state.update(at_rest(1.0, 0.0, 0.0)));
  EXPECT_EQ(state.mean(), before);
}

Surface face(double x) {
  return {.centre = {x, 0.0},
          .normal = {0.0, 1.0},
          .half_length_m = 0.5,
          .offset_deviation_m = 0.015,
          .turn_deviation_rad = 0.005};
}

/// The offset of a surface measured `offset_m` from where the map has it, with a pose known that well.
double holds_after(double offset_m, double pose_deviation_m) {
  OffsetState state;
  sensor::RefinedPose pose = at_rest(0.0, 0.0, 0.0);
  pose.covariance(1, 1) = pose_deviation_m * pose_deviation_m;
  state.start(pose);
  state.append(0.0, sensor::kMovedM, kMovedRad);
  measure(state, {{{{1, 1.0}, {kOffset, -1.0}}}, 2}, -offset_m, 1e-4);
  measure(state, {{{{2, -1.0}, {kOffset + 1, -1.0}}}, 2}, 0.0, 1e-5);
  std::vector<SurfaceSwitch> switches{{.surface = face(0.0)}};
  settle(switches, state);
  EXPECT_TRUE(state.is_sound());
  return switches[0].holds;
}

TEST(SurfaceSwitch, TellsAMovedSurfaceFromOneThatHolds) {
  EXPECT_GT(holds_after(0.0, 0.01), 0.95);
  EXPECT_GT(holds_after(0.02, 0.01), 0.9);
  EXPECT_LT(holds_after(0.15, 0.01), 0.05);
  EXPECT_LT(holds_after(-0.5, 0.01), 0.01);
  EXPECT_GT(holds_after(0.15, 0.2), 0.5) << "a pose that may be off explains it as well";
}

TEST(SurfaceSwitch, TakesTwoHalvesOfOneFaceForOneWitness) {
  // Pieces of one face, seen 0.1 m off: whether the pose or the face is off, both halves say the same.
  const auto pose_after = [](int pieces) {
    OffsetState state;
    sensor::RefinedPose pose = at_rest(0.0, 0.0, 0.0);
    pose.covariance(1, 1) = 0.06 * 0.06;
    state.start(pose);
    std::vector<SurfaceSwitch> switches;
    for (int i = 0; i < pieces; ++i) {
      state.append(0.0, sensor::kMovedM, kMovedRad);
      switches.push_back({.surface = face(i)});
      const Eigen::Index at = OffsetState::offset_of(static_cast<std::size_t>(i));
      measure(state, {{{{1, 1.0}, {at, -1.0}}}, 2}, -0.1, 1e-4);
      measure(state, {{{{2, -1.0}, {at + 1, -1.0}}}, 2}, 0.0, 1e-5);
    }
    settle(switches, state);
    return switches.front().holds;
  };
  EXPECT_NEAR(pose_after(4), pose_after(1), 0.2);
}

}  // namespace
}  // namespace deltamap::localization::surfaces
