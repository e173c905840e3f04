// SPDX-License-Identifier: Apache-2.0
// Who drives. Off unless a person asked for it: a daemon that starts does not move the robot.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace deltamap::navigation {

enum class DriveMode : std::uint8_t {
  kOff,    ///< nobody: motors are left as they are, no velocity is sent
  kWander  ///< reactive, needs no pose
};

[[nodiscard]] constexpr std::string_view name_of(DriveMode mode) {
  return mode == DriveMode::kWander ? "wander" : "off";
}

[[nodiscard]] constexpr std::optional<DriveMode> drive_mode_named(std::string_view name) {
  for (const DriveMode mode : {DriveMode::kOff, DriveMode::kWander}) {
    if (name == name_of(mode)) return mode;
  }
  return std::nullopt;
}

}  // namespace deltamap::navigation
