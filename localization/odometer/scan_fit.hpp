// SPDX-License-Identifier: Apache-2.0
// Where in the surfel map a scan fits: robust point-to-line registration (Censi 2008) with a prediction as a weak
// prior, and how surely. Noisy normals pretend to know the way along a bare corridor, and so does a single person who
// walks along: what these alone support counts as not known.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

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

/// One scan held against a map; both must live as long.
class ScanFitter {
 public:
  ScanFitter(const SurfelMap& map, std::span<const LinePoint> points);

  /// How many points lie near surfels at a pose: mean of 1 / (1 + e² / (0.1 m)²) over some of the points on lines.
  [[nodiscard]] double score(const Pose2& map_from_robot) const;
  /// Starts from a pose that is off by about `start_off_m`.
  [[nodiscard]] Pose2 registered(const Pose2& start, double start_off_m, const FitPrior& prior);
  /// The share of the points on lines that lie on a surfel at a pose.
  [[nodiscard]] double inlier_share(const Pose2& map_from_robot);
  /// How surely the scan fits at a pose where it has been registered.
  [[nodiscard]] ScanFit judged(const Pose2& map_from_robot);

 private:
  struct Match {
    const LinePoint* point = nullptr;
    Eigen::Vector2d at{0.0, 0.0};  // on the surfel, map frame
    Eigen::Vector2f normal{0.0F, 0.0F};
    float weight = 0.0F;
  };
  /// The surfels near the points at a pose; those of a pose close by will do.
  void match(const Pose2& map_from_robot);

  const SurfelMap& map_;
  std::span<const LinePoint> points_;
  std::size_t lines_;  // points on lines
  std::vector<Match> matches_;
  Pose2 matched_at_;
  bool has_matched_ = false;
};

}  // namespace deltamap::localization::odometer
