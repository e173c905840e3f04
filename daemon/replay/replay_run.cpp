// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/replay_run.hpp"

#include <chrono>
#include <memory>
#include <utility>

#include "core/files/grid_file.hpp"
#include "daemon/outputs/line_file.hpp"
#include "daemon/replay/replay.hpp"
#include "daemon/system/used_memory.hpp"
#include "daemon/telemetry/stage.hpp"

namespace deltamap::daemon {

Settings settings_that_ran(const ReplayJob& job) {
  const Settings as_delivered;
  Settings ran = job.settings;
  ran.map.file = job.map.string();
  ran.map.store = as_delivered.map.store;
  ran.map.newest = as_delivered.map.newest;
  ran.recording.file = as_delivered.recording.file;
  ran.incidents.folder = as_delivered.incidents.folder;
  ran.robot.port = as_delivered.robot.port;
  ran.laser.port = as_delivered.laser.port;
  return ran;
}

RunReport run_replay(const ReplayJob& job, const ReplayProgress& progress) {
  const auto began = std::chrono::steady_clock::now();
  const double began_cpu_s = process_cpu_s();
  GridWithNotes read = read_grid_with_notes(job.map);
  const auto warn = [&](const std::string& line) {
    if (job.warn && !line.empty()) job.warn(line);
  };
  for (const std::string& note : read.notes) warn(note);
  auto given = std::make_shared<const OccupancyGrid>(std::move(read.grid));
  require_map_elsewhere(job.map, job.out);
  const RecordedRun recorded = recorded_run(job);
  const ReplayStart begun = replay_start(recorded, job, std::move(given));
  require_pose_on(begun.start.map->geometry(), job.settings);
  warn(doubt_of_pose(*begun.start.map, job.settings));
  StagingFolder staging{job.out};
  RunReport report;
  {
    FileMessages source{job.recording, {job.from_s, job.to_s}, job.settings};
    FolderOutput output{staging.path(), *begun.start.map, begun.start.revision, job.settings.mapping.things};
    Replay replay{{job, recorded, begun, source, output}};
    replay.run(progress);
    report = replay.finish();
  }
  report.cpu_total_s = process_cpu_s() - began_cpu_s;
  report.recording_file = job.recording.string();
  report.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  report.peak_resident_bytes = peak_resident_bytes();
  LineFile file{staging.path() / "report.json"};
  file.write(json_text(report, settings_that_ran(job)));
  file.flush();
  staging.commit();
  return report;
}

}  // namespace deltamap::daemon
