// SPDX-License-Identifier: Apache-2.0
// Runs a simulation in real time on two pseudo-terminals or TCP ports: the clock, the ports, the orders on standard
// input and the truth file around simulation::Simulation.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "simulation/scenario/scenario.hpp"

namespace deltamap::tool {

struct LiveSimulationOptions {
  std::filesystem::path links = ".";  ///< folder that gets the links `robot` and `laser`
  std::optional<std::uint16_t>
      tcp;  ///< the robot's port on the loopback address, in place of links; the laser's is the next
  std::uint64_t seed = 1;
  std::optional<double> change_every_s;        ///< in place of the scenario's
  std::optional<std::filesystem::path> truth;  ///< JSON lines
  std::optional<double> run_s;                 ///< ends by itself after so many seconds
};

/// Until SIGTERM, SIGINT or the end of its time; the links are gone then. Throws std::runtime_error naming a file or
/// port.
void run_live(const simulation::Scenario& scenario, const LiveSimulationOptions& options);

}  // namespace deltamap::tool
