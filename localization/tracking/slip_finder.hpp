// SPDX-License-Identifier: Apache-2.0
// Proposes poses after a slip of the wheels. From one scan to the next the predicted pose ceases to fit, while
// somewhere near it the scan fits as before. Random particles seldom come within centimetres of that pose, so it is
// searched for directly: refinements of the scan from poses around the predicted one.
#pragma once

#include <span>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "localization/motion/deskew.hpp"
#include "localization/motion/motion_model.hpp"
#include "localization/sensor/likelihood_field.hpp"
#include "localization/sensor/pose_refinement.hpp"

namespace deltamap::localization::tracking {

class SlipFinder {
 public:
  /// `refinement` says how a pose is refined to where the scan fits.
  SlipFinder(const motion::MotionModelParams& motion, const sensor::RefinementParams& refinement)
      : motion_{motion}, refinement_{refinement} {}

  /// Poses near the one that the wheels tell where the scan fits nearly as scans of late did, map frame; none where the
  /// wheels' own still does, or slips are never believed. `ends` must not be empty; `beam_share` as of refined().
  [[nodiscard]] std::span<const Pose2> slips(const sensor::LikelihoodField& field, const motion::BeamEnds& ends,
                                             const Pose2& by_wheels, double beam_share);

  /// What was believed at a scan that has ends.
  void learn(const sensor::LikelihoodField& field, const motion::BeamEnds& ends, const Pose2& believed);
  /// The pose was set, not driven to.
  void forget() { usual_fit_ = 0.0; }

 private:
  motion::MotionModelParams motion_;
  sensor::RefinementParams refinement_;
  double usual_fit_ = 0.0;  // mean likelihood of a scan of late where it was believed to be; 0: none yet
  std::vector<Pose2> slips_;
};

}  // namespace deltamap::localization::tracking
