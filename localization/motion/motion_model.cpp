// SPDX-License-Identifier: Apache-2.0
// Why a turn, a drive and a turn: the error of a heading grows with the way and the turn, and then carries the robot
// aside the farther it drives. Noise added to x, y and heading alone would not tie the three together.
#include "localization/motion/motion_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace deltamap::localization::motion {
namespace {

constexpr double kDirectionIsNoiseM = 0.010;

double turned_rad(double rot_rad) { return std::min(std::abs(rot_rad), std::numbers::pi - std::abs(rot_rad)); }

}  // namespace

PoseCovariance covariance_along(double direction_rad, double along_m2, double aside_m2, double turn_rad2) {
  const Eigen::Vector2d along{std::cos(direction_rad), std::sin(direction_rad)};
  const Eigen::Vector2d aside{-along.y(), along.x()};
  PoseCovariance covariance = PoseCovariance::Zero();
  covariance.topLeftCorner<2, 2>() = along_m2 * along * along.transpose() + aside_m2 * aside * aside.transpose();
  covariance(2, 2) = turn_rad2;
  return covariance;
}

std::vector<Pose2> slips_around(const MotionModelParams& params, const Pose2& pose) {
  std::vector<Pose2> poses;
  for (const double turn : {0.0, -0.5, 0.5, -1.0, 1.0, -1.5, 1.5, -2.0, 2.0}) {  // deviations
    for (const double ahead : kSlipsAhead) {
      poses.push_back(pose * Pose2{ahead * params.slip_m, 0.0, turn * params.slip_rad});
    }
  }
  return poses;
}

PoseCovariance unknown_motion_covariance(const MotionModelParams& params, double unknown_s) {
  const double unknown_m = params.unknown_speed_m_per_s * unknown_s;
  const double unknown_rad = params.unknown_turn_rate_rad_per_s * unknown_s;
  return Eigen::Vector3d{unknown_m * unknown_m, unknown_m * unknown_m, unknown_rad * unknown_rad}.asDiagonal();
}

PoseCovariance slip_covariance(const MotionModelParams& params, double heading_rad) {
  const double aside_m = kSlipSideways * params.slip_m;
  return covariance_along(heading_rad, params.slip_m * params.slip_m, aside_m * aside_m,
                          params.slip_rad * params.slip_rad);
}

TurnDriveTurn turn_drive_turn(const Pose2& motion) {
  const double trans_m = std::hypot(motion.x, motion.y);
  if (trans_m < kDirectionIsNoiseM) return {0.0, motion.x, motion.theta};
  const double rot1_rad = std::atan2(motion.y, motion.x);
  return {rot1_rad, trans_m, wrapped_angle(motion.theta - rot1_rad)};
}

MotionModelParams less_sure(MotionModelParams params, const MotionVariance& by) {
  params.position_floor_m = std::sqrt(params.position_floor_m * params.position_floor_m + by.position_m2);
  params.heading_floor_rad = std::sqrt(params.heading_floor_rad * params.heading_floor_rad + by.heading_rad2);
  return params;
}

MotionModelParams as_unsure(MotionModelParams params, const MotionVariance& as) {
  params.turn_per_turn = params.turn_per_metre_rad = params.metre_per_metre = params.metre_per_turn_m = 0.0;
  params.position_floor_m = std::sqrt(as.position_m2);
  params.heading_floor_rad = std::sqrt(as.heading_rad2);
  return params;
}

MotionNoise motion_noise(const TurnDriveTurn& motion, double unknown_s, const MotionModelParams& params) {
  const double rot1_rad = turned_rad(motion.rot1_rad);
  const bool on_the_spot = std::abs(motion.trans_m) < kDirectionIsNoiseM;
  const double rot2_rad = on_the_spot ? std::abs(motion.rot2_rad) : turned_rad(motion.rot2_rad);
  const double unknown_m = params.unknown_speed_m_per_s * unknown_s;
  const double unknown_rad = params.unknown_turn_rate_rad_per_s * unknown_s;
  const double along_m = std::hypot(params.position_floor_m, unknown_m);
  return {
      .rot1_rad = std::hypot(params.turn_per_turn * rot1_rad, params.turn_per_metre_rad * motion.trans_m),
      .trans_m = std::hypot(params.metre_per_metre * motion.trans_m,
                            params.metre_per_turn_m * std::hypot(rot1_rad, rot2_rad), along_m),
      .sideways_m = along_m,
      .rot2_rad = std::hypot(params.turn_per_turn * rot2_rad, params.turn_per_metre_rad * motion.trans_m,
                             std::hypot(params.heading_floor_rad, unknown_rad)),
  };
}

Pose2 sampled_motion(const Pose2& map_from_robot, const TurnDriveTurn& motion, const MotionNoise& noise,
                     const Ziggurat& ziggurat, Random& random) {
  const double rot1_rad = motion.rot1_rad + noise.rot1_rad * ziggurat.normal(random);
  const double trans_m = motion.trans_m + noise.trans_m * ziggurat.normal(random);
  const double sideways_m = noise.sideways_m * ziggurat.normal(random);
  const double rot2_rad = motion.rot2_rad + noise.rot2_rad * ziggurat.normal(random);
  const double direction_rad = map_from_robot.theta + rot1_rad;
  const auto direction = static_cast<float>(direction_rad);  // far finer than the noise
  const auto c = static_cast<double>(std::cos(direction));
  const auto s = static_cast<double>(std::sin(direction));
  return {map_from_robot.x + trans_m * c - sideways_m * s, map_from_robot.y + trans_m * s + sideways_m * c,
          wrapped_angle(direction_rad + rot2_rad)};
}

}  // namespace deltamap::localization::motion
