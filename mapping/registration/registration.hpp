// SPDX-License-Identifier: Apache-2.0
// Brings points onto a surface: iterated closest line (Censi, "An ICP variant using a point-to-line metric", 2008) with
// a prior, by Gauss–Newton. What neither points nor prior observe stays where it was.
#pragma once

#include <span>

#include "mapping/registration/surface.hpp"

namespace deltamap::mapping::registration {

struct RegistrationParams {
  int most_iterations = 40;
  double first_reach_m = 0.5;        ///< pairs farther apart do not count at first …
  double last_reach_m = 0.12;        ///< … and at the end; > 0, <= first_reach_m
  double point_deviation_m = 0.02;   ///< spread of a point around its line, at least; > 0
  double settled_m = 1e-5;           ///< a step below this (and the same in rad) ends the iteration …
  double settled_deviations = 0.05;  ///< … and so does one below this share of its own σ
};

/// A belief about the pose that is sought; zero information = none.
struct PoseBelief {
  Pose2 pose;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< inverse covariance of (x, y, θ)
};

struct Registration {
  Pose2 reference_from_moving;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of (x, y, θ) from the points alone, prior not included
  double deviation_m = 0.0;  ///< root mean square distance of the paired points to their lines
  std::size_t paired = 0;    ///< points that found a line within the last reach
  bool settled = false;
};

/// Moves `points_in_moving` from `initial` onto the surface of the reference frame. The heading turns about the moving
/// frame's origin: keep it near the points, where the covariance of a robot's pose is meant.
[[nodiscard]] Registration registration(std::span<const Point2> points_in_moving, const NearestSurface& reference,
                                        const Pose2& initial, const PoseBelief& prior,
                                        const RegistrationParams& params);

}  // namespace deltamap::mapping::registration
