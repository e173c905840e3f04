// SPDX-License-Identifier: Apache-2.0
// Reads who moves and changes things in a scenario: the fork-lift's work, containers that creep, people, actors and
// doors.
#pragma once

#include "simulation/scenario/scenario.hpp"
#include "simulation/scenario/yaml_section.hpp"

namespace deltamap::simulation {

// They throw std::runtime_error naming file, line and key.
[[nodiscard]] ForkliftParams forklift_of(YamlSection lift);
[[nodiscard]] CreepParams creep_of(YamlSection creep);
[[nodiscard]] ChangedStartParams changed_start_of(YamlSection start);
[[nodiscard]] PersonParams person_of(YamlSection person);
[[nodiscard]] ActorParams actor_of(YamlSection actor);
[[nodiscard]] DoorParams door_of(YamlSection door);

}  // namespace deltamap::simulation
