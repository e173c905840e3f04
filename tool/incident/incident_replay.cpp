// SPDX-License-Identifier: Apache-2.0
#include "tool/incident/incident_replay.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/counted.hpp"
#include "core/utc_text.hpp"
#include "daemon/incidents/incident_watch.hpp"

namespace deltamap::tool {

using daemon::IncidentEvent;
using daemon::IncidentKind;

const IncidentEvent* loss_of(const daemon::Incident& incident) {
  const auto found = std::find_if(incident.events.begin(), incident.events.end(), [](const IncidentEvent& event) {
    return event.kind == IncidentKind::kLost || event.kind == IncidentKind::kKidnapped;
  });
  return found == incident.events.end() ? nullptr : &*found;
}

IncidentReplay replayed_incident(const daemon::Incident& incident, daemon::ReplayJob job,
                                 const daemon::ReplayProgress& progress) {
  IncidentReplay answer;
  daemon::PoseWatch watch;
  job.watch.scan = [&](const daemon::ReplayedScan& scan) {
    if (auto event = watch.observe(scan.row)) answer.losses.push_back(*std::move(event));
  };
  answer.report = daemon::run_replay(job, progress);
  const IncidentEvent* live = loss_of(incident);
  for (const IncidentEvent& again : answer.losses) {
    if (live == nullptr || again.kind != live->kind) continue;
    const double late_s = seconds(again.time - live->time);
    if (!answer.late_s || std::abs(late_s) < std::abs(*answer.late_s)) answer.late_s = late_s;
  }
  return answer;
}

std::string words_of(const daemon::Incident& incident, const IncidentReplay& replay) {
  const std::string met = "the replay lost its pose " + counted(replay.losses.size(), "time") + ", ";
  const IncidentEvent* live = loss_of(incident);
  if (live == nullptr) return met + "the live run did not: " + std::string(name_of(incident.events.front().kind));
  const std::string began = "the live run: " + std::string(name_of(live->kind)) + " at " + utc_text(live->time) + "; ";
  if (!replay.late_s) return began + met + "never of this kind";
  char text[96];
  (void)std::snprintf(text, sizeof text, "the replay: the same %.1f s %s", std::abs(*replay.late_s),
                      *replay.late_s < 0.0 ? "earlier" : "later");
  return began + text;
}

}  // namespace deltamap::tool
