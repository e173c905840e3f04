// SPDX-License-Identifier: Apache-2.0
// How fast the controller lets the robot move, speed up and brake (protocols.md A5: SETV, SETRV, SETA, SETRA), and what
// it has confirmed of that (A10, CONFIGpac). Commands are never acknowledged: a limit counts only once it was read
// back.
#pragma once

#include <optional>
#include <vector>

#include "core/geometry/angle.hpp"
#include "drivers/pioneer/command.hpp"
#include "drivers/pioneer/config_packet.hpp"

namespace deltamap::drivers::pioneer {

/// What the controller is asked to keep to; all > 0.
struct MotionLimits {
  double max_speed_m_per_s = 0.4;
  double max_turn_rate_rad_per_s = radians(50.0);
  double acceleration_m_per_s2 = 0.3;
  double deceleration_m_per_s2 = 1.0;
  double turn_acceleration_rad_per_s2 = radians(100.0);
  double turn_deceleration_rad_per_s2 = radians(150.0);
};

// What goes over the wire is whole.
[[nodiscard]] int whole_mm(double metres);
[[nodiscard]] int whole_degrees(double rad);

/// SETV, SETRV, SETA twice, SETRA twice.
[[nodiscard]] std::vector<Command> limit_commands(const MotionLimits& limits);
/// Whether the controller reports all of them, to the whole mm and degree of the wire, and its watchdog.
[[nodiscard]] bool shows(const ConfigPacket& config, const MotionLimits& limits);

/// How a robot that nobody speaks to any more comes to rest: it goes on for `watchdog_s`, then brakes.
struct StoppingLimits {
  std::optional<double> watchdog_s;    ///< silence after which it stops by itself; infinite: never; nothing: not told
  double deceleration_m_per_s2 = 0.3;  ///< flash default of a P3-DX until the controller has reported its own
  double turn_deceleration_rad_per_s2 = radians(100.0);  ///< flash default until then
};

/// What the controller has reported in this connection.
[[nodiscard]] StoppingLimits stopping_limits_of(const std::optional<ConfigPacket>& config);

}  // namespace deltamap::drivers::pioneer
