// SPDX-License-Identifier: Apache-2.0
#include "localization/motion/motion_model.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <numbers>

namespace deltamap::localization::motion {
namespace {

using std::numbers::pi;

TEST(MotionModel, TakesAMotionApartIntoTurnDriveTurn) {
  const TurnDriveTurn motion = turn_drive_turn({0.3, 0.3, 1.0});
  EXPECT_NEAR(motion.rot1_rad, pi / 4.0, 1e-12);
  EXPECT_NEAR(motion.trans_m, std::hypot(0.3, 0.3), 1e-12);
  EXPECT_NEAR(motion.rot2_rad, 1.0 - pi / 4.0, 1e-12);
}

TEST(MotionModel, TakesNoDirectionFromLessThanTenMillimetres) {
  const TurnDriveTurn motion = turn_drive_turn({0.001, 0.009, 0.2});
  EXPECT_EQ(motion.rot1_rad, 0.0);
  EXPECT_EQ(motion.rot2_rad, 0.2);
  EXPECT_EQ(turn_drive_turn({-0.009, 0.0, 0.0}).trans_m, -0.009);
}

TEST(MotionModel, CountsReversingAsNoTurn) {
  const MotionModelParams params;
  const MotionNoise forward = motion_noise(turn_drive_turn({0.5, 0.01, 0.0}), 0.0, params);
  const MotionNoise backward = motion_noise(turn_drive_turn({-0.5, 0.01, 0.0}), 0.0, params);
  EXPECT_NEAR(forward.rot1_rad, backward.rot1_rad, 1e-12);
  EXPECT_NEAR(forward.trans_m, backward.trans_m, 1e-12);
  EXPECT_NEAR(forward.rot2_rad, backward.rot2_rad, 1e-12);
}

TEST(MotionModel, GrowsWithTheTimeWithoutOdometry) {
  const MotionModelParams params{.unknown_speed_m_per_s = 0.3, .unknown_turn_rate_rad_per_s = 0.2};
  const MotionNoise noise = motion_noise({}, 10.0, params);
  EXPECT_NEAR(noise.trans_m, 3.0, 0.01);
  EXPECT_NEAR(noise.sideways_m, 3.0, 0.01);
  EXPECT_NEAR(noise.rot2_rad, 2.0, 0.01);
}

TEST(MotionModel, NeverLetsAStandingRobotsGuessesFallTogether) {
  const MotionNoise noise = motion_noise({}, 0.0, {});
  EXPECT_GT(noise.trans_m, 0.0);
  EXPECT_GT(noise.sideways_m, 0.0);
  EXPECT_GT(noise.rot2_rad, 0.0);
}

TEST(MotionModel, IsAsUnsureAsScansThatHaveToldTheMotion) {
  const MotionModelParams params = as_unsure({}, {.position_m2 = 4e-4, .heading_rad2 = 1e-4});
  const MotionNoise noise = motion_noise(turn_drive_turn({1.0, 0.0, 1.0}), 0.0, params);
  EXPECT_NEAR(noise.trans_m, 0.02, 1e-9);
  EXPECT_LT(std::hypot(noise.rot1_rad, noise.rot2_rad), 0.0151) << "the wheels' own would be ten times as much";
}

TEST(MotionModel, DrawsWithTheMomentsItStates) {
  constexpr int kDraws = 40000;
  constexpr double kTolerance = 0.03;  // relative; the error of a deviation from 40000 draws is 0.4 %
  const Pose2 start{2.0, -1.0, 0.7};
  const TurnDriveTurn motion = turn_drive_turn({0.4, 0.1, 0.3});
  const MotionNoise noise{.rot1_rad = 0.02, .trans_m = 0.05, .sideways_m = 0.01, .rot2_rad = 0.04};
  const Ziggurat ziggurat;
  Random random{5};
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  Eigen::Array3d squares = Eigen::Array3d::Zero();
  for (int i = 0; i < kDraws; ++i) {
    const Pose2 end = sampled_motion(start, motion, noise, ziggurat, random);
    // along and across the direction of the drive, and the turn
    const double direction_rad = start.theta + motion.rot1_rad;
    const double dx = end.x - start.x;
    const double dy = end.y - start.y;
    const Eigen::Array3d sample{dx * std::cos(direction_rad) + dy * std::sin(direction_rad),
                                dy * std::cos(direction_rad) - dx * std::sin(direction_rad),
                                turn_between(start.theta, end.theta)};
    sum += sample;
    squares += sample * sample;
  }
  const Eigen::Array3d mean = sum / kDraws;
  const Eigen::Array3d deviation = (squares / kDraws - mean * mean).sqrt();
  EXPECT_NEAR(mean.x(), motion.trans_m, 0.002);
  EXPECT_NEAR(mean.y(), 0.0, 0.002);
  EXPECT_NEAR(mean.z(), 0.3, 0.002);
  EXPECT_NEAR(deviation.x(), 0.05, kTolerance * 0.05);
  EXPECT_NEAR(deviation.y(), std::hypot(0.01, 0.02 * motion.trans_m), kTolerance * 0.02);
  EXPECT_NEAR(deviation.z(), std::hypot(0.02, 0.04), kTolerance * 0.05);
}

}  // namespace
}  // namespace deltamap::localization::motion
