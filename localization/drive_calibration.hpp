// SPDX-License-Identifier: Apache-2.0
// What driving among surfaces has told of the robot itself: systematic errors of its wheels and of the laser's mount.
#pragma once

#include "core/pose2.hpp"

namespace deltamap::localization {

/// What the robot did, in terms of what its wheels counted (Kelly 2004).
struct WheelErrors {
  double distance = 0.0;         ///< share driven beyond the count
  double turn = 0.0;             ///< share turned beyond the count
  double drift_rad_per_m = 0.0;  ///< turned in a metre that counts as straight
  double lag_s = 0.0;            ///< the wheels' stamps are that much too late
};

struct DriveCalibration {
  WheelErrors wheels;
  WheelErrors wheel_deviations;
  Pose2 mount_error;  ///< moves a beam's end from where the mount that was told has it, robot frame
  Pose2 mount_deviations;
};

}  // namespace deltamap::localization
