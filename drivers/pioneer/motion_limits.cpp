// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/motion_limits.hpp"

#include <cmath>
#include <limits>

namespace deltamap::drivers::pioneer {

int whole_mm(double metres) { return static_cast<int>(std::lround(1000.0 * metres)); }
int whole_degrees(double rad) { return static_cast<int>(std::lround(degrees(rad))); }

std::vector<Command> limit_commands(const MotionLimits& limits) {
  return {{CommandNumber::kSetV, whole_mm(limits.max_speed_m_per_s)},
          {CommandNumber::kSetRv, whole_degrees(limits.max_turn_rate_rad_per_s)},
          {CommandNumber::kSetA, whole_mm(limits.acceleration_m_per_s2)},
          {CommandNumber::kSetA, -whole_mm(limits.deceleration_m_per_s2)},
          {CommandNumber::kSetRa, whole_degrees(limits.turn_acceleration_rad_per_s2)},
          {CommandNumber::kSetRa, -whole_degrees(limits.turn_deceleration_rad_per_s2)}};
}

bool shows(const ConfigPacket& config, const MotionLimits& limits) {
  return config.watchdog_ms && config.trans_vel_max == whole_mm(limits.max_speed_m_per_s) &&
         config.rot_vel_max == whole_degrees(limits.max_turn_rate_rad_per_s) &&
         config.trans_acc == whole_mm(limits.acceleration_m_per_s2) &&
         config.trans_decel == whole_mm(limits.deceleration_m_per_s2) &&
         config.rot_acc == whole_degrees(limits.turn_acceleration_rad_per_s2) &&
         config.rot_decel == whole_degrees(limits.turn_deceleration_rad_per_s2);
}

StoppingLimits stopping_limits_of(const std::optional<ConfigPacket>& config) {
  StoppingLimits limits;
  if (!config) return limits;
  if (config->watchdog_ms) {
    limits.watchdog_s =
        *config->watchdog_ms > 0 ? 1e-3 * *config->watchdog_ms : std::numeric_limits<double>::infinity();
  }
  if (config->trans_decel > 0) limits.deceleration_m_per_s2 = 1e-3 * config->trans_decel;
  if (config->rot_decel > 0) limits.turn_deceleration_rad_per_s2 = radians(config->rot_decel);
  return limits;
}

}  // namespace deltamap::drivers::pioneer
