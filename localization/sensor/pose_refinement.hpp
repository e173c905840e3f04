// SPDX-License-Identifier: Apache-2.0
// Refines a pose to where a scan fits the map best: Gauss-Newton on the distances of the likelihood field, each beam
// weighted by the probability that it hit what the map has, with the prior pose and its covariance as a constraint.
#pragma once

#include "core/geometry/angle.hpp"
#include "localization/motion/deskew.hpp"
#include "localization/sensor/likelihood_field.hpp"

namespace deltamap::localization::sensor {

struct RefinementParams {
  int steps = 6;                            ///< Gauss-Newton steps at most; 0..30, 0 = off
  double prior_share = 0.3;                 ///< how strongly the particles' covariance holds the pose; 0..10
  double longest_shift_m = 0.3;             ///< a refined pose farther from the particles' mean is refused, m; > 0
  double largest_turn_rad = radians(10.0);  ///< and one that is turned farther, rad; > 0
  double alike_beams = 100.0;               ///< beams, of this and other scans, that share an error of the map; >= 1
};

struct RefinedPose {
  Pose2 map_from_robot;
  PoseCovariance covariance = PoseCovariance::Zero();
};

/// What the beams themselves tell of their errors, as running means over scans: how far their ends lie from the contour
/// where the map explains them.
struct BeamErrors {
  double explained = 0.0;   ///< beams that the map explains
  double squares_m2 = 0.0;  ///< sum of their squared distances from the contour

  void blend_in(const BeamErrors& scan, double share);
  /// What counts as one independent beam's squared error, m². The laser errs anew with every beam; what goes beyond it
  /// is the map's, and that is shared by the beams on one wall, scan after scan.
  [[nodiscard]] double variance_m2(double range_deviation_m, double alike_beams) const;
};

struct Refinement {
  RefinedPose pose;
  BeamErrors errors;  ///< with this scan's
};

/// Is a step of (x, y, θ) too small to go on?
[[nodiscard]] bool is_settled(const Eigen::Vector3d& step);

/// `hold` is the covariance that holds the pose near the prior; the prior's own says how far that may be off.
/// `beam_share`: what one beam's evidence counts, in (0, 1]; neighbouring beams see the same things.
[[nodiscard]] Refinement refined(const LikelihoodField& field, const motion::BeamEnds& ends, const RefinedPose& prior,
                                 const PoseCovariance& hold, BeamErrors known, double beam_share,
                                 const RefinementParams& params);
/// A single look, held by the prior's own covariance.
[[nodiscard]] inline RefinedPose refined(const LikelihoodField& field, const motion::BeamEnds& ends,
                                         const RefinedPose& prior, double beam_share, const RefinementParams& params) {
  return refined(field, ends, prior, prior.covariance, {}, beam_share, params).pose;
}

}  // namespace deltamap::localization::sensor
