// SPDX-License-Identifier: Apache-2.0
// How far the pose may be off that the beams of a scan vote by.
#pragma once

#include <cmath>

#include "core/geometry/pose_spread.hpp"
#include "core/messages.hpp"

namespace deltamap::mapping::votes {

/// By the covariance without what all scans err alike; the heading also by the error of the scan's time in a turn.
[[nodiscard]] inline PoseDeviation pose_deviation(const Estimate& estimate, double turn_rate_rad_per_s) {
  constexpr double kClockDeviationS = 0.01;
  PoseDeviation deviation = deltamap::pose_deviation(estimate.noise_covariance());
  deviation.heading_rad += std::abs(turn_rate_rad_per_s) * kClockDeviationS;
  return deviation;
}

}  // namespace deltamap::mapping::votes
