// SPDX-License-Identifier: Apache-2.0
// One drive through a drawn world, with everything that is asked of it: the pose's course, and where the map may be
// updated what became of the map.
#pragma once

#include <memory>
#include <optional>

#include "daemon/settings/settings.hpp"
#include "experiments/experiment.hpp"
#include "simulation/scenario/scenario.hpp"
#include "simulation/virtual_drive.hpp"

namespace deltamap::experiments {

struct WatchedRun {
  simulation::Scenario scenario;
  simulation::VirtualDriveParams drive;
  std::shared_ptr<const OccupancyGrid> first_map;
  daemon::Settings settings;  ///< mapping.enabled false: the map is never updated
  double minutes = 60.0;
  bool knows_start = true;
};

/// Its numbers, and the label "cause"; a row of its scan table for every second, and a picture of its two trajectories.
[[nodiscard]] Outcome watched_drive(const WatchedRun& run);

}  // namespace deltamap::experiments
