// SPDX-License-Identifier: Apache-2.0
// A room of 6 m by 4 m with one block of 1 m by 1 m, and a robot in its corner.
#pragma once

#include "simulation/scenario/scenario.hpp"

namespace deltamap::test {

inline simulation::Scenario block_room() {
  return simulation::parse_scenario(R"(
walls:
  - [[0, 0], [6, 0], [6, 4], [0, 4], [0, 0]]
blocks:
  - {corner: [3, 1], columns: 1, rows: 1, size: [1, 1]}
robot:
  start: [1, 1, 0]
)",
                                    "room");
}

}  // namespace deltamap::test
