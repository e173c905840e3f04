// SPDX-License-Identifier: Apache-2.0
// How bodies that walk or drive by themselves keep out of each other's way.
#pragma once

namespace deltamap::simulation {

inline constexpr double kRoomToRobot_m = 0.5;     ///< between bodies
inline constexpr double kRoomToSurface_m = 0.15;  ///< between body and surface
inline constexpr double kPatience_s = 4.0;        ///< before turning back

}  // namespace deltamap::simulation
