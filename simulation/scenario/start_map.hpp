// SPDX-License-Identifier: Apache-2.0
// M_0 of a scenario: what a perfect survey of the initial world would have drawn; of any world, for scoring.
#pragma once

#include "core/grid/occupancy_grid.hpp"
#include "simulation/scenario/scenario.hpp"

namespace deltamap::simulation {

/// Surfaces that can be seen from the floor where the robot starts are occupied, that floor is free; the inside of
/// containers, what lies behind walls and surfaces that nobody can see are unknown. Surfaces on round coordinates lie
/// in the middle of a cell, so that noise does not scatter them over two.
[[nodiscard]] OccupancyGrid start_map(const World& world, const Point2& robot_start, double resolution_m);

/// The same of a scenario's world, its doors drawn shut or open as it says; who surveyed has been on both sides of
/// them.
[[nodiscard]] OccupancyGrid start_map(const Scenario& scenario, double resolution_m);

/// The same on a given grid.
[[nodiscard]] OccupancyGrid surveyed_map(const World& world, const Point2& robot_start, const GridGeometry& geometry);

/// The cells that the surface of a shape passes through.
[[nodiscard]] std::vector<Cell> surface_cells(const Shape& shape, const GridGeometry& geometry);

}  // namespace deltamap::simulation
