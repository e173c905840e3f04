// SPDX-License-Identifier: Apache-2.0
// The delivered scenario of the paper's room, in which nothing is moved.
#pragma once

#include "simulation/scenario/scenario.hpp"
#include "tests/support/files/source_tree.hpp"

namespace deltamap::test {

inline simulation::Scenario quiet_room() {
  auto scenario = simulation::read_scenario(source_path("config/scenarios/room.yaml"));
  scenario.forklift.reset();
  return scenario;
}

}  // namespace deltamap::test
