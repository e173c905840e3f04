// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/motion_limits.hpp"

#include <limits>

namespace deltamap::drivers::pioneer {

StoppingLimits stopping_limits_of(const std::optional<ConfigPacket>& config) {
  StoppingLimits limits;
  if (!config) return limits;
  limits.is_confirmed = true;
  limits.watchdog_s = config->watchdog_ms > 0 ? 1e-3 * config->watchdog_ms : std::numeric_limits<double>::infinity();
  if (config->trans_decel > 0) limits.deceleration_m_per_s2 = 1e-3 * config->trans_decel;
  if (config->rot_decel > 0) limits.turn_deceleration_rad_per_s2 = radians(config->rot_decel);
  return limits;
}

}  // namespace deltamap::drivers::pioneer
