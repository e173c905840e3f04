// SPDX-License-Identifier: Apache-2.0
// The odometry motion model of Thrun, Burgard and Fox, "Probabilistic Robotics", 2005, Table 5.6: a motion is a turn, a
// straight line and a turn, and each gets noise in proportion to the others.
#pragma once

#include <array>
#include <vector>

#include "core/geometry/angle.hpp"
#include "core/geometry/pose2.hpp"
#include "core/random.hpp"
#include "core/ziggurat.hpp"
#include "localization/motion/motion_variance.hpp"

namespace deltamap::localization::motion {

/// Deviations, not variances: alpha_1 of the book is turn_per_turn², and so on.
struct MotionModelParams {
  double turn_per_turn = 0.15;               ///< deviation of a turn, rad a rad of turn; >= 0 (√α1)
  double turn_per_metre_rad = radians(6.9);  ///< deviation of a turn, rad a metre driven; >= 0 (√α2)
  double metre_per_metre = 0.07;             ///< deviation of a distance, m a metre driven; >= 0 (√α3)
  double metre_per_turn_m = 0.02;            ///< deviation of a distance, m a rad of turn; >= 0 (√α4)
  double position_floor_m = 0.01;  ///< deviation that every step gets, m; > 0: a standing robot's particles stay apart
  double heading_floor_rad = radians(0.172);           ///< deviation that every step gets, rad; > 0
  double unknown_speed_m_per_s = 0.3;                  ///< deviation a second without odometry, m; >= 0
  double unknown_turn_rate_rad_per_s = radians(17.2);  ///< deviation a second without odometry, rad; >= 0
  double slip_probability = 1e-7;  ///< that wheels slip or someone pushes, a step; 0..0.1, 0 = never
  double slip_m = 0.2;             ///< deviation of what is then lost or made up, m; > 0
  double slip_rad = radians(5.0);  ///< deviation of the heading that is lost or made up, rad; > 0
};

/// Deviation of a slip across the robot's way, as a share of that along it.
inline constexpr double kSlipSideways = 0.25;
/// How far along its way a slip is looked for, in deviations; none first.
inline constexpr std::array kSlipsAhead{0.0, -0.75, 0.75, -1.5, 1.5};

/// Of a pose that errs along a direction of the map, across it and in its heading, each for itself: variances.
[[nodiscard]] PoseCovariance covariance_along(double direction_rad, double along_m2, double aside_m2, double turn_rad2);

/// Of a robot's pose in the map once its wheels have slipped, by the model.
[[nodiscard]] PoseCovariance slip_covariance(const MotionModelParams& params, double heading_rad);

/// Poses about one, as far apart as slips may take the robot: to refine from.
[[nodiscard]] std::vector<Pose2> slips_around(const MotionModelParams& params, const Pose2& pose);

/// Added to a pose by so many seconds without odometry, by the model: variances.
[[nodiscard]] PoseCovariance unknown_motion_covariance(const MotionModelParams& params, double unknown_s);

/// The model of a step that is more unsure than the wheels usually are.
[[nodiscard]] MotionModelParams less_sure(MotionModelParams params, const MotionVariance& by);

/// The model of a step that is exactly so unsure.
[[nodiscard]] MotionModelParams as_unsure(MotionModelParams params, const MotionVariance& as);

/// A motion between two odometry poses: turn, drive, turn.
struct TurnDriveTurn {
  double rot1_rad = 0.0;
  double trans_m = 0.0;  ///< along rot1; negative only for steps below 10 mm
  double rot2_rad = 0.0;
};

/// Below 10 mm of translation the direction is noise (1 mm steps): rot1 = 0 and rot2 is the whole turn.
[[nodiscard]] TurnDriveTurn turn_drive_turn(const Pose2& motion);

/// Deviations of one step's noise.
struct MotionNoise {
  double rot1_rad = 0.0;
  double trans_m = 0.0;
  double sideways_m = 0.0;
  double rot2_rad = 0.0;
};

/// Reversing is no half turn: each turn counts as min(|rot|, π - |rot|).
[[nodiscard]] MotionNoise motion_noise(const TurnDriveTurn& motion, double unknown_s, const MotionModelParams& params);

/// Where a robot may be after the motion: one draw.
[[nodiscard]] Pose2 sampled_motion(const Pose2& map_from_robot, const TurnDriveTurn& motion, const MotionNoise& noise,
                                   const Ziggurat& ziggurat, Random& random);

}  // namespace deltamap::localization::motion
