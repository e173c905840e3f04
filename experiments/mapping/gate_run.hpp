// SPDX-License-Identifier: Apache-2.0
// One drive of `gate`: the robot maps while a fork-lift works, then something befalls it, and it drives on. What was
// written while its pose was wrong, what of that stayed, and how long nothing could be written.
#pragma once

#include <cstdint>

#include "daemon/settings/settings.hpp"
#include "experiments/drive/pose_event.hpp"
#include "experiments/experiment.hpp"
#include "simulation/scenario/scenario.hpp"

namespace deltamap::experiments {

struct GateRun {
  simulation::Scenario scenario;
  daemon::Settings settings;
  PoseEvent event = PoseEvent::kNothing;
  std::uint64_t seed = 1;
  double change_every_s = 20.0;  ///< of the fork-lift: something is always waiting to be written
  double before_s = 120.0;
  double after_s = 180.0;
  double wrong_pose_m = 0.3;  ///< error of the pose from which a cell counts as written astray
  double look_back_s = 60.0;  ///< after the writing: what of that still stands?
};

/// Its numbers, and a row for every scan; no labels.
[[nodiscard]] Outcome outcome_of(const GateRun& run);

}  // namespace deltamap::experiments
