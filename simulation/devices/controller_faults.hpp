// SPDX-License-Identifier: Apache-2.0
// What a robot's controller and a laser do and say wrongly, and what people and power do to them, on order. Everything
// at its default: nothing.
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
  bool tells_stall = false;           ///< both wheels, whatever holds them
  std::uint8_t front_bumpers = 0;     ///< segments that are pressed, bits 0 to 4; none: as the body is touched
  std::uint16_t fault_flags = 0;

  // Buttons and power.
  bool stop_button = false;  ///< is held pressed
  bool estall = false;
  int motors_button_presses = 0;  ///< so far
  int resets = 0;                 ///< so far

  friend bool operator==(const ControllerFaults&, const ControllerFaults&) = default;
};

/// Of an LMS200, beside what it measures (robot/laser_faults.hpp).
struct LaserUnitFaults {
  bool sends_no_acks = false;  ///< it obeys and answers, the ACK before it is lost
  bool sends_naks = false;     ///< to every request, and obeys none
  std::uint8_t status = 0;     ///< of its scans in place of "no error" (protocols.md B6); 0: as it is

  int restarts = 0;         ///< so far: its power is cut for a moment
  double start_up_s = 3.0;  ///< of silence after the newest of these, >= 0

  friend bool operator==(const LaserUnitFaults&, const LaserUnitFaults&) = default;
};

}  // namespace deltamap::simulation::devices
