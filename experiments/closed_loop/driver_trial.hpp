// SPDX-License-Identifier: Apache-2.0
// A drive without a map in which one thing after another goes wrong with lines, devices and people's hands: how soon
// the drivers deliver again, whether anything wrong became data, and whether the robot moved where it must not.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/settings/settings.hpp"
#include "simulation/scenario/scenario.hpp"

namespace deltamap::experiments {

/// The names of simulation/faults of which a drive without a map can tell; all others need one (fault_trial).
[[nodiscard]] std::vector<std::string_view> driver_faults();

struct DriverTrial {
  std::uint64_t seed = 1;
  double for_s = 60.0;                   ///< new faults begin for so long
  std::vector<std::string_view> faults;  ///< drawn from these
};

struct TriedDriverFault {
  std::string name;
  std::string order;               ///< as `deltamap sim` takes it
  double begins_s = 0.0;           ///< since the start
  double back_after_s = 0.0;       ///< by the host's clock, its end until scans and odometry come as they should
  bool is_back_soon = false;       ///< within 3 s, and of a laser that starts up within a second more than 60 s
  double lasted_s = 0.0;           ///< 0: over in a moment
  std::vector<std::string> lines;  ///< that the log has of it, but for how fast it drives
};

struct DriverTrialOutcome {
  std::vector<TriedDriverFault> faults;
  int wrong_frames = 0;                ///< that a decoder gave and no device sent
  int wrong_scans = 0;                 ///< that the driver gave and the laser has not measured
  int collisions = 0;                  ///< of a body that its own wheels moved
  std::vector<std::string> forbidden;  ///< each motion where it must stand, in words
  double moved_m = 0.0;
};

/// `settings` are made to fit the scenario.
[[nodiscard]] DriverTrialOutcome outcome_of(const DriverTrial& trial, const simulation::Scenario& scenario,
                                            const daemon::Settings& settings);

}  // namespace deltamap::experiments
