// SPDX-License-Identifier: Apache-2.0
// The world and the robot of a kind: everything that a drive needs, by the seed alone.
#pragma once

#include <cstdint>
#include <memory>

#include "core/grid/occupancy_grid.hpp"
#include "simulation/drawn/drawn.hpp"
#include "simulation/drawn/unseen_kind.hpp"

namespace deltamap::simulation::drawn {

struct UnseenWorld {
  Drawn drawn;
  OccupancyGrid first_map;  ///< M_0, as the robot is given it
};

[[nodiscard]] UnseenWorld unseen_world(const UnseenKind& kind, std::uint64_t seed);

}  // namespace deltamap::simulation::drawn
