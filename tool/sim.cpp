// SPDX-License-Identifier: Apache-2.0
// `deltamap sim`: plays a P3-DX and an LMS200 in a simulated world, or draws that world's first map, or tells what can
// go wrong.
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/files/grid_file.hpp"
#include "simulation/scenario/start_map.hpp"
#include "tool/live_simulation.hpp"
#include "tool/scenario_place.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {
namespace {

struct SimOptions {
  std::string world;
  std::filesystem::path write_map;
  double resolution_m = 0.05;
  std::string subtype;
  std::vector<std::string> faults;
  double fault_after_s = 0.0;
  std::optional<double> fault_lasts_s;
  LiveSimulationOptions live;
};

simulation::Scenario wanted_scenario(const SimOptions& options) {
  simulation::Scenario scenario = simulation::read_scenario(scenario_file(options.world));
  if (!options.subtype.empty()) scenario = simulation::with_robot(std::move(scenario), options.subtype);
  for (const std::string& fault : options.faults) {
    scenario.faults.push_back(simulation::fault_order(fault, options.fault_after_s, options.fault_lasts_s));
  }
  return scenario;
}

void simulate(const SimOptions& options) {
  const simulation::Scenario scenario = wanted_scenario(options);
  if (options.write_map.empty()) return run_live(scenario, options.live);
  write_grid(simulation::start_map(scenario, options.resolution_m), options.write_map);
}

/// For wrong usage; empty: none.
std::string complaint_about_fault(const std::string& text) {
  try {
    (void)simulation::fault_order(text);
    return {};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

}  // namespace

void add_sim(CLI::App& app) {
  auto options = std::make_shared<SimOptions>();
  CLI::App& sim = *app.add_subcommand("sim", "a robot and its laser on two pseudo-terminals, in a world that changes");
  sim.add_option("--world", options->world, "scenario: a YAML file, or the name of a delivered one")->required();
  sim.add_option("--links", options->live.links, "folder for the links robot and laser (default: here)");
  sim.add_option("--tcp", options->live.tcp,
                 "the robot on this TCP port of 127.0.0.1, the laser on the next, in place of links")
      ->check(CLI::Range(1, 65534))
      ->excludes("--links");
  sim.add_option("--seed", options->live.seed, "seed of everything that happens by chance (default 1)");
  sim.add_option("--truth", options->live.truth, "write the true pose and every change, JSON lines");
  sim.add_option("--for", options->live.run_s, "end after so many seconds")->check(CLI::PositiveNumber);
  sim.add_option("--change-every", options->live.change_every_s, "seconds between changes, in place of the scenario's")
      ->check(CLI::PositiveNumber);
  sim.add_option("--subtype", options->subtype, "the robot that it is, in place of the scenario's: p3dx, p3at, ...");
  sim.add_option("--fault", options->faults,
                 "something that goes wrong, [T:]NAME[:NUMBER][:SECONDS]; several may be given; help on standard input "
                 "tells which")
      ->check(CLI::Validator{[](const std::string& text) { return complaint_about_fault(text); }, "FAULT"});
  sim.add_option("--fault-after", options->fault_after_s, "seconds from the start until then (default 0)")
      ->check(CLI::NonNegativeNumber);
  sim.add_option("--fault-for", options->fault_lasts_s, "seconds that it lasts (default: for ever)")
      ->check(CLI::PositiveNumber);
  CLI::Option& map =
      *sim.add_option("--write-map", options->write_map, "write the map of the world at the start (YAML) and end");
  sim.add_option("--resolution", options->resolution_m, "of that map, m a cell (default 0.05)")
      ->check(CLI::Range(0.005, 1.0))
      ->needs(&map);
  for (const char* of_a_drive : {"--links", "--tcp", "--seed", "--truth", "--for", "--change-every", "--fault",
                                 "--fault-after", "--fault-for"}) {
    map.excludes(sim.get_option(of_a_drive));  // nothing drives, and nothing changes
  }
  sim.callback([options] { simulate(*options); });
}

}  // namespace deltamap::tool
