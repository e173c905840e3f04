// SPDX-License-Identifier: Apache-2.0
// One drive of the daemon in a world: what it bumped into, why it stood, and what it told planners.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "daemon/settings/settings.hpp"
#include "navigation/stop_reason.hpp"
#include "simulation/scenario/scenario.hpp"

namespace deltamap::experiments {

/// Of a run, before anybody says drive: laser and robot have been found by then.
inline constexpr double kConnectS = 7.0;

struct LoopRun {
  simulation::Scenario scenario;  ///< with its faults
  daemon::Settings settings;      ///< as fitting() makes them, changed as wanted
  std::uint64_t seed = 1;
  double before_s = 0.0;             ///< driving until a fault is counted with
  double for_s = 60.0;               ///< after that
  bool has_pilot_gone_wild = false;  ///< somebody drives by hand at full speed, wherever that leads
};

struct LoopOutcome {
  int collisions = 0;  ///< of a body that its own wheels moved, after before_s
  double fastest_collision_m_per_s = 0.0;
  double driven_before_m = 0.0;
  double moved_m = 0.0;                 ///< of the body, after before_s
  double stopped_after_s = -1.0;        ///< until the last moment at which a speed was allowed; -1: none was
  navigation::StopReason reason{};      ///< at the end
  double may_drive_at_end_share = 0.0;  ///< of the last 10 s, in which planners were told that they may drive
  std::map<std::string, int> stops;     ///< that began, by name, while the pose was within 0.3 m of the truth
  double pose_off_m = 0.0;              ///< of the newest estimate at its time, at the end
  int walls_freed = 0;                  ///< cells of the first map that are occupied there, and free at the end
  std::string told;                     ///< the first line of the log that says that driving stops, after before_s
};

[[nodiscard]] LoopOutcome outcome_of(const LoopRun& run);

/// Settings of a daemon that fits the devices and the start of a scenario.
[[nodiscard]] daemon::Settings fitting(const simulation::Scenario& scenario, daemon::Settings settings = {});

}  // namespace deltamap::experiments
