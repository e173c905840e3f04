// SPDX-License-Identifier: Apache-2.0
// How far a pose may be off, by its covariance, and the beams that are read from it.
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/geometry/pose2.hpp"

namespace deltamap {

/// Squared deviations of (x, y, θ) that 99.9 % of poses stay within: χ² of 3 degrees of freedom.
inline constexpr double kMostChi2 = 16.27;

/// Squared deviations of a pose that is off by (x, y, θ); above kMostChi2 the covariance does not explain it. The
/// covariance is positive definite.
[[nodiscard]] inline double squared_deviations(const Eigen::Vector3d& off, const PoseCovariance& covariance) {
  return off.dot(covariance.inverse() * off);
}

/// σ of the position along the longest axis of its ellipse, m.
[[nodiscard]] inline double widest_deviation_m(const PoseCovariance& covariance) {
  const double middle = 0.5 * (covariance(0, 0) + covariance(1, 1));
  const double half = std::hypot(0.5 * (covariance(0, 0) - covariance(1, 1)), covariance(0, 1));
  return std::sqrt(std::max(0.0, middle + half));
}

/// What a pose's error becomes at the end of a motion that leads it from here to there, both in the frame of the error.
[[nodiscard]] inline Eigen::Matrix3d carrying(const Pose2& from, const Pose2& to) {
  Eigen::Matrix3d by_start = Eigen::Matrix3d::Identity();
  by_start(0, 2) = from.y - to.y;
  by_start(1, 2) = to.x - from.x;
  return by_start;
}
/// The covariance of a pose at the end of a motion that is known exactly.
[[nodiscard]] inline PoseCovariance carried(const PoseCovariance& covariance, const Pose2& from, const Pose2& to) {
  return carrying(from, to) * covariance * carrying(from, to).transpose();
}

/// 1 σ of the pose that beams are read by.
struct PoseDeviation {
  double position_m = 0.0;
  double heading_rad = 0.0;

  /// How far aside of where the pose puts it a beam may lie, at a distance from the laser.
  [[nodiscard]] double aside_m(double distance_m) const {
    const double turned_m = distance_m * heading_rad;
    return std::sqrt(position_m * position_m +
                     turned_m * turned_m);  // asked for each beam: hypot costs ten times as much
  }
};

/// The covariance's own with a floor: estimates are too sure of themselves.
[[nodiscard]] inline PoseDeviation pose_deviation(const PoseCovariance& covariance) {
  constexpr double kLeastPositionM = 0.01;
  constexpr double kLeastHeadingRad = 0.004;
  return {std::hypot(widest_deviation_m(covariance), kLeastPositionM),
          std::hypot(std::sqrt(std::max(0.0, covariance(2, 2))), kLeastHeadingRad)};
}

/// A beam fits the map within so many σ of where it should end.
inline constexpr double kBeamDeviations = 2.0;
/// Half width of the interval in which its range is expected, m: the pose errs, and so does the laser.
[[nodiscard]] inline double expected_within_m(double aside_m, double range_deviation_m) {
  return kBeamDeviations * std::sqrt(aside_m * aside_m + range_deviation_m * range_deviation_m);
}
/// So far behind what it went through a beam must end, m, besides: else it may have met it.
inline constexpr double kClearlyBeyondM = 0.2;

}  // namespace deltamap
