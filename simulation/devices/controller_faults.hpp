// SPDX-License-Identifier: Apache-2.0
// What a robot's controller does and says wrongly, on order. Everything at its default: nothing.
#pragma once

#include <cstdint>
#include <optional>

namespace deltamap::simulation::devices {

struct ControllerFaults {
  // How it disobeys. ESTOP, its watchdog and motors that are switched off stop it all the same.
  bool keeps_set_points = false;               ///< what it is told of motion is lost: it goes on as it was told before
  std::optional<double> goes_at_m_per_s{};     ///< ahead, whatever speed it is told
  std::optional<double> turns_at_rad_per_s{};  ///< counter-clockwise, whatever turn rate it is told
  double speed_factor = 1.0;                   ///< of the speed that it is told
  double turn_factor = 1.0;                    ///< of the turn rate that it is told

  // What its SIPs say (protocols.md A6).
  bool charger_power = false;         ///< bit 10 of the flags
  std::uint8_t charge_state = 0;      ///< 0 no, 1 bulk, 2 overcharge, 3 float
  std::optional<double> battery_v{};  ///< in place of the true voltage, >= 0
  bool tells_no_battery = false;      ///< the SIP ends before the 16-bit voltage, and its byte is 0

  friend bool operator==(const ControllerFaults&, const ControllerFaults&) = default;
};

}  // namespace deltamap::simulation::devices
