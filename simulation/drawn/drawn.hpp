// SPDX-License-Identifier: Apache-2.0
// A world that a seed has drawn, and a robot that drives about in it.
#pragma once

#include "simulation/scenario/scenario.hpp"
#include "simulation/virtual_drive.hpp"

namespace deltamap::simulation::drawn {

struct Drawn {
  Scenario scenario;
  VirtualDriveParams drive;
};

}  // namespace deltamap::simulation::drawn
