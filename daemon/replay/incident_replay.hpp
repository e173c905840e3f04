// SPDX-License-Identifier: Apache-2.0
// An incident replayed: whether it meets the same again.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "daemon/incidents/incident.hpp"
#include "daemon/replay/replay_run.hpp"

namespace deltamap::daemon {

/// With the incident's own recording, map and settings, and no `out`; bays and zones are those of the recording. Throws
/// as read_settings() does.
[[nodiscard]] ReplayJob incident_job(const std::filesystem::path& folder);

/// The first of its events that a replay can meet: lost or kidnapped; null: none.
[[nodiscard]] const IncidentEvent* loss_of(const Incident& incident);

struct IncidentReplay {
  RunReport report;
  std::vector<IncidentEvent> losses;  ///< that the replay met, in order
  /// By how much the replay met the incident's first loss later: of its losses of that kind the nearest in time.
  /// Nothing where either has none.
  std::optional<double> late_s;
};
/// `job` as incident_job() makes it, with an `out`; its watch of scans is taken. Throws as run_replay() does.
[[nodiscard]] IncidentReplay replayed_incident(const Incident& incident, ReplayJob job, const ReplayProgress& progress);

}  // namespace deltamap::daemon
