// SPDX-License-Identifier: Apache-2.0
// One Gauss-Newton step's sums over a scan: how the distances of its ends from the map's contours pull at a pose, each
// beam weighted by how probably it hit what the map knows. The second hot path after weighing.hpp: four beams at once.
#pragma once

#include "core/geometry/angle.hpp"
#include "localization/motion/deskew.hpp"
#include "localization/sensor/likelihood_field.hpp"

namespace deltamap::localization::sensor {

/// With d the distance of an end from the contour, bilinear between the cells' centres, J = ∂d/∂(x, y, θ), w the
/// probability that the map explains the beam, and σ the field's deviation. Where the field is flat, and outside the
/// map, a beam says nothing.
struct NormalEquations {
  Eigen::Matrix3d information;  ///< Σ w JᵀJ / σ²
  Eigen::Vector3d pull;         ///< Σ w Jᵀd / σ²
  double explained = 0.0;       ///< Σ w
  double squares_m2 = 0.0;      ///< Σ w d²
};

[[nodiscard]] NormalEquations normal_equations(const LikelihoodField& field, const motion::BeamEnds& ends,
                                               const Pose2& map_from_robot);

}  // namespace deltamap::localization::sensor
