// SPDX-License-Identifier: Apache-2.0
// The pose that a run starts from, or that a person gives later.
#pragma once

#include "core/geometry/pose2.hpp"

namespace deltamap::localization::particles {

/// Where the robot's frame lies in the map at the first scan, and how far to trust it.
struct InitialPose {
  Pose2 map_from_robot;
  double position_deviation_m = 0.2;
  double heading_deviation_rad = 0.17453292519943295;  // 10°
  bool remembered = false;  ///< believed only once the first scans fit; where they do not, the whole map is searched
};

}  // namespace deltamap::localization::particles
