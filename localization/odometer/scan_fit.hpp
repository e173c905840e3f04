// SPDX-License-Identifier: Apache-2.0
// Where in the surfel map a scan fits: robust point-to-line registration (Censi 2008) with a prediction as a weak
// prior, and how surely. Noisy normals pretend to know the way along a bare corridor, and so does a single person who
// walks along: what these alone support counts as not known.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/geometry/pose2.hpp"
#include "localization/odometer/surfel_map.hpp"

namespace deltamap::localization::odometer {

/// A pose that is looked for, and what is thought of it before.
struct FitPrior {
  Pose2 map_from_robot;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of (x, y, θ), map frame
};

struct ScanFit {
  Pose2 map_from_robot;
  PoseCovariance covariance = PoseCovariance::Zero();  ///< map frame
  double inliers = 0.0;                                ///< share of the points on lines that lie on a surfel
  std::size_t lines = 0;                               ///< points on lines
};

/// How many points lie near surfels at a pose: mean of 1 / (1 + e² / (0.1 m)²) over some of the points on lines.
[[nodiscard]] double score(const SurfelMap& map, std::span<const LinePoint> points, const Pose2& map_from_robot);

/// The share of the points on lines that lie on a surfel at a pose.
[[nodiscard]] double inlier_share(const SurfelMap& map, std::span<const LinePoint> points, const Pose2& map_from_robot);

/// Starts from a pose that is off by about `start_off_m`. Covariance and inliers are not yet known.
[[nodiscard]] Pose2 registered(const SurfelMap& map, std::span<const LinePoint> points, const Pose2& start,
                               double start_off_m, const FitPrior& prior);

/// How surely a scan that has been registered fits there.
[[nodiscard]] ScanFit judged(const SurfelMap& map, std::span<const LinePoint> points, const Pose2& map_from_robot);

}  // namespace deltamap::localization::odometer
