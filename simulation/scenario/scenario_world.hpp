// SPDX-License-Identifier: Apache-2.0
// Reads what stands in a scenario: walls, blocks of containers, posts and racks of posts, panes of glass, wrapped
// pallets.
#pragma once

#include "simulation/scenario/scenario.hpp"
#include "simulation/scenario/yaml_section.hpp"

namespace deltamap::simulation {

/// Fills Scenario::world and Scenario::slots. Throws std::runtime_error naming file, line and key.
void read_world(YamlSection& top, Scenario& scenario);

}  // namespace deltamap::simulation
