// SPDX-License-Identifier: Apache-2.0
// The robots that have the controller of a P3-DX: unit of the odometry, track and hull (protocols.md A7).
#pragma once

#include <string_view>

namespace deltamap::simulation::devices {

inline constexpr double kHalfTrack_m = 0.1786;  ///< between a wheel of a P3-DX and its centre (A7)

struct RobotKind {
  double metres_per_unit = 0.001;
  double half_track_m = kHalfTrack_m;
  double hull_m = 0.25;  ///< radius
};

/// By the longest beginning of the subtype that is known; one like a p3dx-sh where none is.
[[nodiscard]] RobotKind kind_of(std::string_view subtype);

}  // namespace deltamap::simulation::devices
