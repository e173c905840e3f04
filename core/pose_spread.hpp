// SPDX-License-Identifier: Apache-2.0
// How far a pose may be off, by its covariance.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/pose2.hpp"

namespace deltamap {

/// Squared deviations of (x, y, θ) that 99.9 % of poses stay within: χ² of 3 degrees of freedom.
inline constexpr double kMostChi2 = 16.27;

/// σ of the position along the longest axis of its ellipse, m.
[[nodiscard]] inline double widest_deviation_m(const PoseCovariance& covariance) {
  const double middle = 0.5 * (covariance(0, 0) + covariance(1, 1));
  const double half = std::hypot(0.5 * (covariance(0, 0) - covariance(1, 1)), covariance(0, 1));
  return std::sqrt(std::max(0.0, middle + half));
}

}  // namespace deltamap
