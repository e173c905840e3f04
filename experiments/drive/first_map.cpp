// SPDX-License-Identifier: Apache-2.0
#include "experiments/drive/first_map.hpp"

#include "simulation/scenario/start_map.hpp"

namespace deltamap::experiments {

std::shared_ptr<const simulation::Scenario> scenario_of(const Options& options, const std::string& file) {
  return std::make_shared<const simulation::Scenario>(simulation::read_scenario(options.scenarios / file));
}

std::shared_ptr<const OccupancyGrid> first_map(const simulation::Scenario& scenario) {
  constexpr double kResolution_m = 0.05;
  return std::make_shared<const OccupancyGrid>(simulation::start_map(scenario, kResolution_m));
}

}  // namespace deltamap::experiments
