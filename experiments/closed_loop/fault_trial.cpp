// SPDX-License-Identifier: Apache-2.0
#include "experiments/closed_loop/fault_trial.hpp"

#include "core/geometry/angle.hpp"

namespace deltamap::experiments {
namespace {

constexpr std::string_view kMount = "mount-turned=";

}  // namespace

LoopRun run_of(const FaultTrial& trial, const simulation::Scenario& scenario, const daemon::Settings& settings) {
  LoopRun run;
  run.scenario = scenario;
  run.settings = fitting(scenario, settings);
  run.seed = trial.seed;
  run.before_s = trial.before_s;
  run.for_s = trial.for_s;
  if (trial.fault.starts_with(kMount)) {
    run.settings.laser.session.robot_from_laser.theta = radians(std::stod(trial.fault.substr(kMount.size())));
  } else {
    const double begins_s = trial.before_s > 0.0 ? kConnectS + trial.before_s : 0.0;
    run.scenario.faults.push_back(simulation::fault_order(trial.fault, begins_s));
  }
  return run;
}

}  // namespace deltamap::experiments
