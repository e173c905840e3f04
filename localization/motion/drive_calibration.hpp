// SPDX-License-Identifier: Apache-2.0
// Systematic errors that are estimated while driving: of the wheels (Kelly 2004) and of the laser's mount.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/geometry/pose2.hpp"

namespace deltamap::localization::motion {

/// What the robot did, in terms of what its wheels counted (Kelly 2004).
struct WheelErrors {
  double distance = 0.0;         ///< share driven beyond the count
  double turn = 0.0;             ///< share turned beyond the count
  double drift_rad_per_m = 0.0;  ///< turned in a metre that counts as straight
  double lag_s = 0.0;            ///< the wheels' stamps are that much too late
};

/// What the wheels counted from one instant to the next.
struct WheelStep {
  Pose2 motion;
  double speed_change_m_per_s = 0.0;  ///< between the two instants
  double turn_rate_change_rad_per_s = 0.0;
};

/// What the robot did meanwhile.
[[nodiscard]] Pose2 corrected(const WheelStep& step, const WheelErrors& errors);

struct DriveCalibration {
  WheelErrors wheels;
  WheelErrors wheel_deviations;
  Pose2 mount_error;  ///< moves a beam's end from where the mount that was told has it, robot frame
  Pose2 mount_deviations;
};

/// Wheels, their deviations, mount, its deviations, each in the order of its fields: to be kept and read again.
[[nodiscard]] std::array<double, 14> numbers_of(const DriveCalibration& calibration);
/// Nothing where it is not what numbers_of() gives.
[[nodiscard]] std::optional<DriveCalibration> calibration_of(std::span<const double> numbers);

}  // namespace deltamap::localization::motion
