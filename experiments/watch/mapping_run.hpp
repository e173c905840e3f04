// SPDX-License-Identifier: Apache-2.0
// One drive of robot, localizer and mapper from beginning to end, and what came of it.
#pragma once

#include <string>

#include "daemon/settings/settings.hpp"
#include "experiments/experiment.hpp"
#include "simulation/scenario/scenario.hpp"
#include "simulation/virtual_drive.hpp"

namespace deltamap::experiments {

struct MappingRun {
  simulation::Scenario scenario;
  simulation::VirtualDriveParams drive;
  daemon::Settings settings;
  double minutes = 60.0;
  int restarts = 0;  ///< of the daemon, evenly over the drive
};

/// Its numbers and its course, a row every five minutes; no labels.
[[nodiscard]] Outcome outcome_of(const MappingRun& run);

/// Both methods over the same drive: "evidence" as the options have it, "paper" as published.
[[nodiscard]] daemon::Settings settings_of(const Options& options, const std::string& method);

}  // namespace deltamap::experiments
