// SPDX-License-Identifier: Apache-2.0
// How far the pose that beams are judged by may be off.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/messages.hpp"
#include "mapping/votes/beam_evidence.hpp"

namespace deltamap::mapping::votes {

struct PoseDeviation {
  double position_m = 0.0;
  double heading_rad = 0.0;

  /// How far aside a beam may lie from where the pose puts it, at a distance from the laser, 1 σ.
  [[nodiscard]] double aside_m(double distance_m) const {
    const double turned_m = distance_m * heading_rad;
    return std::sqrt(position_m * position_m +
                     turned_m * turned_m);  // asked for each beam: hypot costs ten times as much
  }
};

/// The estimate's own deviation with the floors of the parameters.
[[nodiscard]] inline PoseDeviation pose_deviation(const Estimate& estimate, double turn_rate_rad_per_s,
                                                  const BeamEvidenceParams& params) {
  const PoseCovariance c = estimate.noise_covariance();
  const double heading = std::sqrt(std::max(0.0, c(2, 2)));
  return {std::hypot(std::sqrt(std::max(0.0, std::max(c(0, 0), c(1, 1)))), params.least_position_deviation_m),
          std::hypot(heading, params.least_heading_deviation_rad) +
              std::abs(turn_rate_rad_per_s) * params.clock_deviation_s};
}

}  // namespace deltamap::mapping::votes
