// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/incident_replay.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/incidents/incident_watch.hpp"
#include "daemon/settings/settings.hpp"

namespace deltamap::daemon {

ReplayJob incident_job(const std::filesystem::path& folder) {
  ReplayJob job;
  job.recording = folder / kIncidentRecording;
  job.map = folder / kIncidentMap;
  job.settings = read_settings(folder / kIncidentSettings, {});
  job.settings.bays.file.clear();  // the recording holds what was in force; the files are another machine's, or edited
  job.settings.zones.file.clear();
  return job;
}

const IncidentEvent* loss_of(const Incident& incident) {
  const auto found = std::find_if(incident.events.begin(), incident.events.end(), [](const IncidentEvent& event) {
    return event.kind == IncidentKind::kLost || event.kind == IncidentKind::kKidnapped;
  });
  return found == incident.events.end() ? nullptr : &*found;
}

IncidentReplay replayed_incident(const Incident& incident, ReplayJob job, const ReplayProgress& progress) {
  IncidentReplay answer;
  PoseWatch watch;
  job.watch.scan = [&](const ReplayedScan& scan) {
    if (auto event = watch.observe(scan.row)) answer.losses.push_back(*std::move(event));
  };
  answer.report = run_replay(job, progress);
  const IncidentEvent* live = loss_of(incident);
  for (const IncidentEvent& again : answer.losses) {
    if (live == nullptr || again.kind != live->kind) continue;
    const double late_s = seconds(again.time - live->time);
    if (!answer.late_s || std::abs(late_s) < std::abs(*answer.late_s)) answer.late_s = late_s;
  }
  return answer;
}

}  // namespace deltamap::daemon
