// SPDX-License-Identifier: Apache-2.0
// What befalls a simulated robot so that the pose it believes in is wrong from then on.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/random.hpp"
#include "simulation/virtual_drive.hpp"

namespace deltamap::experiments {

enum class PoseEvent : std::uint8_t {
  kNothing,   ///< the pose stays right
  kBay,       ///< carried exactly one container (2.5 m) or one block (15 m) on, heading kept
  kSlip,      ///< 0.3 to 1 m anywhere, 10° at most
  kElsewhere  ///< carried to any free place and heading
};
inline constexpr std::array kPoseEvents{PoseEvent::kNothing, PoseEvent::kBay, PoseEvent::kSlip, PoseEvent::kElsewhere};
[[nodiscard]] std::string_view name_of(PoseEvent event);

/// Odometry notices nothing.
void befall(simulation::VirtualDrive& drive, PoseEvent event, Random& random);

}  // namespace deltamap::experiments
