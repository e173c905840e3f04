// SPDX-License-Identifier: Apache-2.0
// Who drives. Off unless a person asked for it: a daemon that starts does not move the robot.
#pragma once

#include <cstdint>
#include <string_view>

namespace deltamap::navigation {

enum class DriveMode : std::uint8_t {
  kOff,    ///< nobody: motors are left as they are, no velocity is sent
  kWander  ///< reactive, needs no pose
};

[[nodiscard]] constexpr std::string_view name_of(DriveMode mode) {
  return mode == DriveMode::kWander ? "wander" : "off";
}

}  // namespace deltamap::navigation
