// SPDX-License-Identifier: Apache-2.0
// One scan, as those who track the pose read it.
#pragma once

#include <functional>
#include <vector>

#include "localization/motion/deskew.hpp"
#include "localization/motion/scan_instant.hpp"
#include "localization/sensor/likelihood_field.hpp"
#include "localization/sensor/pose_refinement.hpp"
#include "localization/sensor/proposed_pose.hpp"
#include "localization/surfaces/faced_scan.hpp"

namespace deltamap::localization::tracking {

struct SeenScan {
  const motion::ScanInstant& now;
  const motion::BeamEnds& ends;  ///< those that score, robot frame; may be empty
  const sensor::LikelihoodField& field;
  surfaces::FaceFinder& faces;      ///< of all its beams
  motion::BodyVelocity velocity{};  ///< at the scan, by the wheels
  /// Where it fits within a wide prior of the pose; asked for rarely. Empty: nobody looks.
  std::function<std::vector<sensor::ProposedPose>(const sensor::RefinedPose& prior)> poses_within{};
};

}  // namespace deltamap::localization::tracking
