// SPDX-License-Identifier: Apache-2.0
// Slides the best hypothesis to where the scan fits the map best: Gauss-Newton on the distances of the likelihood
// field, each beam weighted by how probably it hit what the map knows. Held back by what the particles already know.
#pragma once

#include "core/angle.hpp"
#include "localization/deskew.hpp"
#include "localization/likelihood_field.hpp"

namespace deltamap::localization {

struct RefinementParams {
  int steps = 6;                            ///< Gauss-Newton steps at most; 0..30, 0 = off
  double prior_share = 0.3;                 ///< how strongly the particles' covariance holds the pose; 0..10
  double longest_shift_m = 0.3;             ///< a refined pose farther from the particles' mean is refused, m; > 0
  double largest_turn_rad = radians(10.0);  ///< likewise, rad; > 0
};

struct RefinedPose {
  Pose2 map_from_robot;
  PoseCovariance covariance = PoseCovariance::Zero();
};

/// Distance of a point of the map frame from the contour, bilinear between the cells' centres, with its slope;
/// flat outside the map.
struct FieldDistance {
  double distance_m = 0.0;
  Eigen::Vector2d slope{0.0, 0.0};  ///< ∂distance/∂x, ∂distance/∂y
};
[[nodiscard]] FieldDistance distance_at(const LikelihoodField& field, double x_m, double y_m);

/// `beam_share`: what one beam's evidence counts, in (0, 1]; neighbouring beams see the same things.
[[nodiscard]] RefinedPose refined(const LikelihoodField& field, const BeamEnds& ends, const RefinedPose& prior,
                                  double beam_share, const RefinementParams& params);

}  // namespace deltamap::localization
