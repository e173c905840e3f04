// SPDX-License-Identifier: Apache-2.0
// Whether a container may stand in a place: beside everything else, and away from the robot and from people.
#pragma once

#include <span>

#include "simulation/world/world.hpp"

namespace deltamap::simulation {

/// Nothing but itself stands there; neighbours may touch.
[[nodiscard]] bool stands_free(const Box& box, int own_id, const World& world);

[[nodiscard]] bool keeps_away(const Box& box, const Circle& body, double margin_m);
[[nodiscard]] bool keeps_away(const Box& box, std::span<const Circle> bodies, double margin_m);

}  // namespace deltamap::simulation
