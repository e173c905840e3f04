// SPDX-License-Identifier: Apache-2.0
// A drive of the daemon that keeps incidents, in which something befalls it after minutes: what it has kept, and what
// replays make of it.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/incidents/incident.hpp"
#include "daemon/settings/settings.hpp"
#include "simulation/scenario/scenario.hpp"

namespace deltamap::experiments {

/// What may befall it: "carried" to another place, "marked" by a person, "laser-off", "cable-pulled", or by the names
/// of simulation/faults.
inline constexpr std::array<std::string_view, 15> kIncidentCauses{"carried",          "marked",
                                                                  "laser-off",        "cable-pulled",
                                                                  "laser-repeats",    "laser-beyond-maximum",
                                                                  "laser-random=10",  "laser-turned=45",
                                                                  "laser-turned=180", "laser-covered-ahead=120",
                                                                  "wheels-spin",      "left-wheel-spins",
                                                                  "wheels-blocked",   "towed=0.3",
                                                                  "keeps-set-points"};

struct IncidentTrial {
  std::string cause;
  double before_s = 150.0;  ///< of driving
  double after_s = 140.0;
  std::uint64_t seed = 1;
};

struct TriedIncident {
  daemon::Incident incident;
  double before_s = 0.0;  ///< of its recording, before its first event
  double after_s = 0.0;   ///< and behind it
  double bytes = 0.0;
  bool has_loss = false;
  bool met_again = false;  ///< its replay lost the pose in the same way
  double late_s = 0.0;     ///< that
};

/// All incidents of the drive, oldest first. `settings` are made to fit the scenario.
[[nodiscard]] std::vector<TriedIncident> incidents_of(const IncidentTrial& trial, const simulation::Scenario& scenario,
                                                      const daemon::Settings& settings);

}  // namespace deltamap::experiments
