// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/pose2.hpp"

namespace deltamap::localization::sensor {

/// A pose at which a scan fits.
struct ProposedPose {
  Pose2 map_from_robot;
  double log_prior = 0.0;  ///< of being there, before the scan, beside the likeliest pose; <= 0
};

}  // namespace deltamap::localization::sensor
