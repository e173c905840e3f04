// SPDX-License-Identifier: Apache-2.0
// What a drive begins with: the scenario, and M_0 as it stands before anything has changed.
#pragma once

#include <memory>
#include <string>

#include "core/grid/occupancy_grid.hpp"
#include "experiments/experiment.hpp"
#include "simulation/scenario/scenario.hpp"

namespace deltamap::experiments {

/// Throws std::runtime_error where it cannot be read.
[[nodiscard]] std::shared_ptr<const simulation::Scenario> scenario_of(const Options& options, const std::string& file);

/// M_0 of a scenario as the experiments use it, 0.05 m a cell.
[[nodiscard]] std::shared_ptr<const OccupancyGrid> first_map(const simulation::Scenario& scenario);

}  // namespace deltamap::experiments
