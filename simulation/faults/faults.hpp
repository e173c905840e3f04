// SPDX-License-Identifier: Apache-2.0
// All that goes wrong on order, now. A field at its default goes wrong no longer; what is over in a moment is counted.
#pragma once

#include "simulation/devices/controller_faults.hpp"
#include "simulation/devices/line_faults.hpp"
#include "simulation/robot/body_faults.hpp"
#include "simulation/robot/laser_faults.hpp"

namespace deltamap::simulation {

struct Faults {
  LaserFaults laser;
  BodyFaults body;
  devices::ControllerFaults controller;
  devices::LaserUnitFaults laser_unit;
  devices::LineFaults robot_line;
  devices::LineFaults laser_line;
  /// By which the host's clock is before the devices', by leaps so far. Who plays the host heeds it: to a host whose
  /// clock has leapt ahead the devices stand still so long, and to one whose clock stood they send so much at once.
  double host_clock_ahead_s = 0.0;

  friend bool operator==(const Faults&, const Faults&) = default;
};

}  // namespace deltamap::simulation
