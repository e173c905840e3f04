// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/replay_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <compare>
#include <memory>
#include <stdexcept>
#include <utility>

#include "core/files/grid_file.hpp"
#include "daemon/maps/revision_keeper.hpp"
#include "daemon/outputs/line_file.hpp"
#include "daemon/records/journal.hpp"
#include "daemon/records/recording_decoder.hpp"
#include "daemon/replay/replay_start.hpp"
#include "daemon/replay/sequential_run.hpp"
#include "daemon/system/used_memory.hpp"
#include "daemon/telemetry/cpu_timer.hpp"
#include "daemon/telemetry/stage.hpp"
#include "drivers/port/replay_port.hpp"

namespace deltamap::daemon {
namespace {

using drivers::port::ReplayPort;
using drivers::port::ReplayWindow;

class Replay {
 public:
  Replay(const ReplayJob& job, const RecordedRun& recorded, const ReplayStart& begun, const std::filesystem::path& out)
      : job_{job},
        journal_{recorded.journal},
        lacks_end_{recorded.faults.lacks_end},
        obeys_{begun.journal == "obeyed"},
        next_command_{journal_.commands().begin()},
        first_revision_{begun.start.revision},
        run_{job.settings, begun.start, obeys_ ? &journal_ : nullptr, job.map_delay_s},
        store_{out / "map_store.sqlite", *begun.start.map},
        trajectory_{out / "trajectory.tum"},
        localization_log_{out / "localization.csv"},
        changes_{out / "changes.jsonl"} {
    localization_log_.write(csv_header());
    report_.began = begun.began;
    report_.journal = begun.journal;
  }

  void run(const ReplayProgress& progress);
  [[nodiscard]] RunReport finish(const std::filesystem::path& out);

 private:
  void take(const Odometry& odometry, std::uint32_t number);
  void take(Scan&& scan);
  void warn(const Estimate& estimate) const;
  void obey_commands_before(const Scan& scan);
  void look_for_changes(const TrackedScan& tracked);
  [[nodiscard]] bool reaches_map(const ScanSet& set, std::uint32_t scan);
  void keep_result(const MapStep::Result& result);

  const ReplayJob& job_;
  const Journal& journal_;
  bool lacks_end_;  // the journal's last notes are missing
  bool obeys_;
  std::vector<Decision>::const_iterator next_command_;
  bool has_begun_ = false;
  bool is_paused_ = false;
  std::uint32_t first_revision_;
  SequentialRun run_;
  mapping::store::MapStore store_;
  LineFile trajectory_;
  LineFile localization_log_;
  LineFile changes_;
  double decoding_cpu_s_ = 0.0;
  double recording_cpu_s_ = 0.0;
  RunReport report_;
};

void Replay::run(const ReplayProgress& progress) {
  ReplayPort port{job_.recording, ReplayWindow{job_.from_s, job_.to_s}};
  RecordingDecoder decoder{job_.settings};
  std::vector<std::pair<Odometry, std::uint32_t>> odometry;
  std::vector<Scan> scans;
  const RecordingDecoder::Sinks sinks{
      [&](Odometry&& message, std::uint32_t number) { odometry.emplace_back(message, number); },
      [&](Scan&& scan) { scans.push_back(std::move(scan)); }};
  for (;;) {
    odometry.clear();
    scans.clear();
    {
      const CpuTimer timer{decoding_cpu_s_};
      const auto replayed = port.next();
      if (!replayed) break;
      decoder.feed(replayed->record, sinks);
      if (!replayed->in_window) {
        report_.outside_window.scans_before += scans.size();
        continue;
      }
    }
    for (const auto& [message, number] : odometry) take(message, number);
    for (Scan& scan : scans) take(std::move(scan));
    const double done = static_cast<double>(port.read_bytes()) / static_cast<double>(port.size_bytes());
    if (!scans.empty() && !progress(done)) throw std::runtime_error("interrupted");
  }
  report_.recording = port.faults();
  report_.outside_window.packets_before = port.packets_before();
  report_.outside_window.packets_after = port.count_packets_after();
  if (report_.scans.decoded == 0) {
    const drivers::port::LogFaults& faults = report_.recording;
    if (faults.cut) throw std::runtime_error(faults.cut->text + "; no scan lies before that");
    throw std::runtime_error(faults.lacks_records ? faults.doubts.front() + "; no scan is left"
                                                  : job_.recording.string() + ": holds no scan in this window");
  }
  report_.wire = decoder.counts();
}

void Replay::take(const Odometry& odometry, std::uint32_t number) {
  ++report_.scans.odometry;
  if (obeys_ && journal_.odometry_was_lost(number)) {
    ++report_.scans.odometry_lost;
    return;
  }
  run_.observe(odometry);
}

void Replay::take(Scan&& scan) {
  ++report_.scans.decoded;
  if (obeys_ && journal_.was_lost(scan.number)) {
    ++report_.scans.lost;
    return;
  }
  if (obeys_ && journal_.was_dropped(scan.number)) {
    ++report_.scans.dropped;
    trajectory_.write(tum_line(run_.localization().pass_over(scan)));
    return;
  }
  const double before_s = run_.cpu().localization_s;
  run_.take_what_is_due(scan);
  obey_commands_before(scan);
  const TrackedScan tracked = run_.observe(std::move(scan));
  const double cost_s = run_.cpu().localization_s - before_s;
  report_.latency.add(cost_s);
  ++report_.scans.localized;
  if (job_.warn) warn(tracked.estimate);
  const LocalizationRow& row = run_.localization().row();
  {
    const CpuTimer timer{recording_cpu_s_};
    trajectory_.write(tum_line({tracked.scan.time, tracked.estimate.map_from_robot}));
    localization_log_.write(csv_line(row));
  }
  if (job_.settings.mapping.enabled && !is_paused_) look_for_changes(tracked);
  if (job_.watch.scan) job_.watch.scan({tracked, row, cost_s, run_.localization().particles(), run_.store_scan()});
}

/// Of what a live run would say of the newest scan, what needs a person.
void Replay::warn(const Estimate& estimate) const {
  const bool is_first = report_.scans.localized == 1;
  const std::string shift = is_first ? shift_from_given_pose(estimate.map_from_robot, job_.settings) : "";
  if (!shift.empty()) job_.warn(shift);
  for (const LogLine& line : run_.localization().lines()) {
    if (!line.is_warning) continue;
    const auto at_s = std::lround(run_.localization().covered_s());
    job_.warn("after " + std::to_string(at_s) + " s: " + line.text);
  }
}

/// Carries out the operator's commands up to this scan. They are inputs as the bytes are, so they count even where the
/// journal's other notes are not obeyed.
void Replay::obey_commands_before(const Scan& scan) {
  for (; next_command_ != journal_.commands().end(); ++next_command_) {
    const Decision& command = *next_command_;
    const auto place = journal_.place_of(command, scan);
    if (std::is_gt(place)) break;
    ++report_.commands;
    const bool is_of_before = !has_begun_ && std::is_lt(place);  // from before the replayed window
    if (command.kind == Decision::Kind::kRelocalized && !is_of_before)
      run_.localization().relocalize(command.map_from_robot);
    if (command.kind == Decision::Kind::kMapSet) keep_result(run_.obey(*command.set));
    if (command.kind == Decision::Kind::kPaused) is_paused_ = true;
    if (is_paused_) run_.localization().apply(std::shared_ptr<const TransientObstacles>{});
    if (command.kind == Decision::Kind::kResumed) is_paused_ = false;
  }
  has_begun_ = true;
}

void Replay::look_for_changes(const TrackedScan& tracked) {
  if (obeys_ && journal_.tracked_was_lost(tracked.scan.number)) {
    ++report_.scans.tracked_lost;
    return;
  }
  const std::optional<MapRequest> request = run_.look_for_changes(tracked);
  if (!request) return;
  if (const auto* set = std::get_if<ScanSet>(&*request); set != nullptr && !reaches_map(*set, tracked.scan.number))
    return;
  if (const auto result = run_.update_map(*request)) return keep_result(*result);
  store_.set_provisional({});  // no revision is provisional any more
}

/// Counts the phase and compares it with the journal; false where the live run lost this set of scans.
bool Replay::reaches_map(const ScanSet& set, std::uint32_t scan) {
  ++report_.phases;
  const auto closing = journal_.closing_scan(set.phase);
  const bool is_unknown = !closing && lacks_end_;
  if (obeys_ && !is_unknown && closing != scan) ++report_.journal_differences;
  if (obeys_ && journal_.set_was_lost(set.phase)) {
    ++report_.scans.sets_lost;
    return false;
  }
  return true;
}

void Replay::keep_result(const MapStep::Result& result) {
  changes_.write(json_line(result.note));
  keep(store_, result, run_.map().method(), first_revision_);
  report_.changes.add(result.note);
  if (job_.watch.change) job_.watch.change(result.revision ? &*result.revision : nullptr, result.note);
}

RunReport Replay::finish(const std::filesystem::path& out) {
  if (obeys_ && journal_.closed_phases() > report_.phases) {
    report_.journal_differences += static_cast<std::uint32_t>(journal_.closed_phases() - report_.phases);
  }
  trajectory_.flush();
  localization_log_.flush();
  changes_.flush();
  write_grid(*run_.map().map(), out / "map.yaml");
  add_to(report_, run_.localization());
  report_.gate_times = run_.store_scan().awareness().gate_times;
  report_.cpu = run_.cpu();
  report_.cpu.decoding_s = decoding_cpu_s_;
  report_.cpu.recording_s = recording_cpu_s_;
  report_.latency_of = "localizing one scan, CPU time";
  return report_;
}

}  // namespace

Settings settings_that_ran(const ReplayJob& job) {
  const Settings as_delivered;
  Settings ran = job.settings;
  ran.map.file = job.map.string();
  ran.map.store = as_delivered.map.store;
  ran.map.newest = as_delivered.map.newest;
  ran.recording.file = as_delivered.recording.file;
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
    Replay replay{job, recorded, begun, staging.path()};
    replay.run(progress);
    report = replay.finish(staging.path());
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
