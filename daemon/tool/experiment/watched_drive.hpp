// SPDX-License-Identifier: Apache-2.0
// One drive through a drawn world, with everything that is asked of it: the pose's course, and where the map may be
// updated what became of the map.
#pragma once

#include <memory>
#include <optional>

#include "daemon/settings.hpp"
#include "daemon/tool/experiment/experiment.hpp"
#include "simulation/scenario.hpp"
#include "simulation/virtual_drive.hpp"

namespace deltamap::daemon::tool::experiment {

struct WatchedRun {
  simulation::Scenario scenario;
  simulation::VirtualDriveParams drive;
  std::shared_ptr<const OccupancyGrid> first_map;
  Settings settings;  ///< mapping.enabled false: the map is never updated
  double minutes = 60.0;
  bool knows_start = true;
};

/// Its numbers, and the label "cause"; a row of its scan table for every second.
[[nodiscard]] Outcome watched_drive(const WatchedRun& run);

}  // namespace deltamap::daemon::tool::experiment
