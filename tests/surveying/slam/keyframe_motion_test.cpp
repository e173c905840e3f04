// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/keyframe_motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

namespace deltamap::surveying::slam {
namespace {

MovedScan at(const Pose2& odom_from_robot, const PoseCovariance& deviation, const Eigen::Matrix3d& kept) {
  MovedScan moved;
  moved.tracked.odom_from_robot = odom_from_robot;
  moved.deviation = deviation;
  moved.kept = kept;
  return moved;
}

PoseCovariance spread(double position_m, double heading_rad) {
  return Eigen::Vector3d{position_m * position_m, position_m * position_m, heading_rad * heading_rad}.asDiagonal();
}

const Eigen::Matrix3d kAllKept = Eigen::Matrix3d::Identity();
const Eigen::Matrix3d kNothingKept = Eigen::Matrix3d::Zero();

TEST(KeyframeMotion, IsAsUnsureAsBothPosesTogetherWhereScansFoundEachAnew) {
  KeyframeMotion motion;
  motion.begin(at({}, spread(0.03, 0.01), kAllKept));
  motion.go_on(at({0.3, 0.0, 0.0}, spread(0.04, 0.01), kNothingKept));
  EXPECT_NEAR(motion.covariance()(0, 0), 0.03 * 0.03 + 0.04 * 0.04, 1e-5);
  EXPECT_NEAR(motion.covariance()(2, 2), 2e-4, 1e-5);
}

TEST(KeyframeMotion, KeepsOnlyWhatHasGrownWhereNothingButTheWheelsTellsTheWay) {
  KeyframeMotion motion;
  motion.begin(at({}, spread(1.0, 0.0), kAllKept));
  PoseCovariance now = spread(1.0, 0.0);
  now(0, 0) += 0.05 * 0.05;
  motion.go_on(at({0.3, 0.0, 0.0}, now, kAllKept));
  EXPECT_NEAR(motion.covariance()(0, 0), 0.05 * 0.05, 1e-5);
  EXPECT_LT(motion.covariance()(1, 1), 1e-5);
}

TEST(KeyframeMotion, IsToldInTheFrameOfTheKeyframe) {
  KeyframeMotion motion;
  motion.begin(at({2.0, 1.0, 0.5}, spread(0.0, 0.0), kAllKept));
  // A quarter turn later the robot knows its own x badly.
  motion.go_on(at(Pose2{2.0, 1.0, 0.5} * Pose2{0.2, 0.1, radians(90.0)}, Eigen::Vector3d{0.04, 0.0, 0.0}.asDiagonal(),
                  kNothingKept));
  EXPECT_NEAR(motion.covariance()(1, 1), 0.04, 1e-4);
  EXPECT_LT(motion.covariance()(0, 0), 1e-4);
  EXPECT_NEAR(motion.keyframe_from_robot().x, 0.2, 1e-9);
}

TEST(KeyframeMotion, KnowsNearlyNothingWhereItWasTornOff) {
  KeyframeMotion motion;
  motion.begin(at({}, spread(0.01, 0.01), kAllKept));
  MovedScan torn = at({}, spread(0.0, 0.0), kNothingKept);
  torn.is_torn_off = true;
  motion.go_on(torn);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes{motion.covariance()};
  EXPECT_GT(axes.eigenvalues().minCoeff(), 0.05);
}

}  // namespace
}  // namespace deltamap::surveying::slam
