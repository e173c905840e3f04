// SPDX-License-Identifier: Apache-2.0
// All that goes wrong on order, now. A field at its default goes wrong no longer. What people and power do to the
// devices (buttons, resets, silences) is ordered at the devices themselves.
#pragma once

#include "simulation/devices/controller_faults.hpp"
#include "simulation/robot/body_faults.hpp"
#include "simulation/robot/laser_faults.hpp"

namespace deltamap::simulation {

struct Faults {
  LaserFaults laser;
  BodyFaults body;
  devices::ControllerFaults controller;

  friend bool operator==(const Faults&, const Faults&) = default;
};

}  // namespace deltamap::simulation
