// SPDX-License-Identifier: Apache-2.0
// An incident replayed: whether it meets the same again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/incidents/incident.hpp"
#include "daemon/replay/replay_run.hpp"

namespace deltamap::tool {

struct IncidentReplay {
  daemon::RunReport report;
  std::vector<daemon::IncidentEvent> losses;  ///< that the replay met, in order
  /// Of the incident's first loss: the one of the same kind that is nearest in time; nothing where either has none.
  std::optional<double> late_s;
};

/// Writes the files of a replay into `out`. Throws std::runtime_error with one line.
[[nodiscard]] IncidentReplay replayed_incident(const daemon::Incident& incident, daemon::ReplayJob job,
                                               const daemon::ReplayProgress& progress);

/// The first of its events that a replay can meet: lost or kidnapped; null: none.
[[nodiscard]] const daemon::IncidentEvent* loss_of(const daemon::Incident& incident);

/// One line: "the live run: lost at …; the replay: 0.1 s later".
[[nodiscard]] std::string words_of(const daemon::Incident& incident, const IncidentReplay& replay);

}  // namespace deltamap::tool
