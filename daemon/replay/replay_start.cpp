// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/replay_start.hpp"

#include <utility>

#include "drivers/port/replay_port.hpp"

namespace deltamap::daemon {
namespace {

/// "revision=3, kept pose, stability, wheels and mount"
std::string content_of(const StartMap& start) {
  std::string content = "revision=" + std::to_string(start.revision);
  if (!start.provisional.empty()) content += " (" + std::to_string(start.provisional.size()) + " provisional)";
  if (start.remembered) content += ", kept pose";
  if (start.stability) content += ", stability";
  if (start.calibration) content += ", wheels and mount";
  return content;
}

constexpr const char* kKeptPoseIsMissing = "not obeyed: it began with a pose that was kept";

std::string journal_state(const RecordedRun& recorded, const ReplayJob& job, const RunIdentity& identity) {
  if (std::string why = why_never_obeyed(recorded); !why.empty()) return why;
  const auto& run = recorded.journal.run();
  if (run->memory != 0 && identity.memory == 0) return kKeptPoseIsMissing;
  if (*run != identity) return "not obeyed: other settings or map";
  if (job.from_s > 0.0) return "not obeyed: another start";
  return "obeyed";
}

}  // namespace

std::string why_never_obeyed(const RecordedRun& recorded) {
  const auto& run = recorded.journal.run();
  if (!run) return "none";
  if (recorded.journal.is_part()) return "not obeyed: the recording begins in mid-run";
  if (recorded.faults.is_unchecked) return "not obeyed: whether records are missing cannot be checked";
  if (recorded.journal.has_gap()) return "not obeyed: records are missing";
  if (run->memory != 0 && !recorded.begin.begin()) return kKeptPoseIsMissing;
  return {};
}

RecordedRun recorded_run(const ReplayJob& job) {
  drivers::port::ReplayPort port{job.recording, {job.from_s, job.to_s}};
  RecordedRun recorded;
  while (const auto replayed = port.next()) {
    const std::string& note = replayed->record.note;
    if (note.empty()) continue;
    if (run_of_note(note)) recorded.begin.forget();
    recorded.begin.read(note);
    recorded.journal.read(note);
  }
  recorded.faults = port.faults();
  if (recorded.faults.lacks_records || recorded.faults.is_unchecked) recorded.journal.lose_records();
  return recorded;
}

FirstMap first_map(std::shared_ptr<const OccupancyGrid> grid) {
  const std::uint64_t hash = grid_hash(*grid);
  return {std::move(grid), hash};
}

ReplayStart replay_start(const RecordedRun& recorded, const ReplayJob& job,
                         std::shared_ptr<const OccupancyGrid> given) {
  return replay_start(recorded, job, first_map(std::move(given)));
}

ReplayStart replay_start(const RecordedRun& recorded, const ReplayJob& job, FirstMap given) {
  RunIdentity identity{settings_fingerprint(job.settings), given.hash};
  const auto& run = recorded.journal.run();
  const auto& begin = recorded.begin.begin();
  ReplayStart answer{{std::move(given.grid), 0}, "the map alone", {}};
  if (begin && run && (identity.map == begin->first_map || identity.map == run->map)) {
    const auto map = begin->start.map ? begin->start.map : answer.start.map;
    answer.start = begin->start;
    answer.start.map = map;
    if (job.from_s > 0.0) answer.start.remembered.reset();  // the robot has driven on since
    answer.began = "what the recorded run began from: " + content_of(answer.start);
    identity.map = grid_hash(*map);
    identity.memory = begin->memory;
  } else if (begin) {
    answer.began = "the map alone: the recorded run began from another one, with " + content_of(begin->start);
  } else if (recorded.begin.is_incomplete()) {
    answer.began = "the map alone: what the recorded run began from is damaged";
  } else if (run && run->memory != 0) {
    answer.began = "the map alone: what the recorded run had kept is not in the recording";
  }
  answer.journal = journal_state(recorded, job, identity);
  const Settings& settings = job.settings;
  answer.start.site = site_on(answer.start.map->geometry(), settings.bays.file, settings.zones.file);
  return answer;
}

std::string why_no_scan(const drivers::port::LogFaults& faults, const std::filesystem::path& recording) {
  if (faults.cut) return faults.cut->text + "; no scan lies before that";
  return faults.lacks_records ? faults.doubts.front() + "; no scan is left"
                              : recording.string() + ": holds no scan in this window";
}

}  // namespace deltamap::daemon
