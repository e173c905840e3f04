// SPDX-License-Identifier: Apache-2.0
// One robot of `carried`: somebody carries it elsewhere right after its start, later the daemon is stopped and started
// again where the robot stands. Nothing in its world changes: whatever its map says otherwise is wrong.
#pragma once

#include <cstdint>

#include "daemon/settings/settings.hpp"
#include "experiments/experiment.hpp"
#include "simulation/scenario/scenario.hpp"

namespace deltamap::experiments {

struct CarriedRun {
  simulation::Scenario scenario;
  daemon::Settings settings;
  std::uint64_t seed = 1;
  double carried_after_s = 5.0;   ///< of the start
  double stopped_after_s = 30.0;  ///< of being carried
  double looks_after_s = 60.0;    ///< of the second start
  bool restarts = true;           ///< false: it is not stopped
  bool is_given_again = false;  ///< the pose of the first start is given at the second one, too: it is in the settings
};

/// Its numbers, and a row for every second; no labels.
[[nodiscard]] Outcome outcome_of(const CarriedRun& run);

}  // namespace deltamap::experiments
