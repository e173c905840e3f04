// SPDX-License-Identifier: Apache-2.0
// M_0 as a survey leaves it: the robot drives about while nobody else does, and a cell is what most beams said of it,
// each from a pose that is a little wrong.
#pragma once

#include "core/grid/occupancy_grid.hpp"
#include "core/random.hpp"
#include "simulation/drawn/drawn.hpp"

namespace deltamap::simulation::drawn {

/// Of the world as it is before anything changes. What the robot has not come to see is unknown.
[[nodiscard]] OccupancyGrid map_of_first_drive(const Drawn& drawn, double resolution_m, Random random);

}  // namespace deltamap::simulation::drawn
