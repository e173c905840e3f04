// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/replay_run.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <utility>

#include "core/grid_file.hpp"
#include "daemon/maps/revision_keeper.hpp"
#include "daemon/outputs/line_file.hpp"
#include "daemon/records/journal.hpp"
#include "daemon/records/recording_decoder.hpp"
#include "daemon/replay/replay_start.hpp"
#include "daemon/replay/revision_queue.hpp"
#include "daemon/replay/things_queue.hpp"
#include "daemon/steps/localization_step.hpp"
#include "daemon/steps/map_step.hpp"
#include "daemon/telemetry/latency_histogram.hpp"
#include "daemon/telemetry/stage.hpp"
#include "drivers/port/replay_port.hpp"
#include "mapping/store_scan.hpp"

namespace deltamap::daemon {
namespace {

using drivers::port::ReplayPort;
using drivers::port::ReplayWindow;

/// Adds the CPU time between its birth and its end.
class CpuTimer {
 public:
  explicit CpuTimer(double& sum_s) : sum_s_{sum_s}, began_s_{thread_cpu_s()} {}
  ~CpuTimer() { sum_s_ += elapsed_s(); }
  CpuTimer(const CpuTimer&) = delete;
  CpuTimer& operator=(const CpuTimer&) = delete;
  [[nodiscard]] double elapsed_s() const { return thread_cpu_s() - began_s_; }

 private:
  double& sum_s_;
  double began_s_;
};

class Replay {
 public:
  Replay(const ReplayJob& job, const RecordedRun& recorded, const ReplayStart& begun, const std::filesystem::path& out)
      : job_{job},
        journal_{recorded.journal},
        is_cut_{recorded.cut.has_value()},
        obeys_{begun.journal == "obeyed"},
        next_command_{journal_.commands().begin()},
        first_revision_{begun.start.revision},
        localization_{job.settings, begun.start},
        store_scan_{job.settings.mapping.store_scan, job.settings.seed},
        map_{job.settings, begun.start},
        revisions_{obeys_ ? &journal_ : nullptr, job.map_delay_s, begun.start.revision},
        things_{obeys_ ? &journal_ : nullptr},
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
  void take(Odometry&& odometry, std::uint32_t number);
  void take(Scan&& scan);
  void obey_commands_before(const Scan& scan);
  void look_for_changes(const TrackedScan& tracked);
  void update_map(const ScanSet& set);
  void keep_result(MapStep::Result result);

  const ReplayJob& job_;
  const Journal& journal_;
  bool is_cut_;  // its last notes are missing
  bool obeys_;
  std::vector<Decision>::const_iterator next_command_;
  bool has_begun_ = false;
  bool is_paused_ = false;
  std::uint32_t first_revision_;
  LocalizationStep localization_;
  mapping::StoreScan store_scan_;
  MapStep map_;
  RevisionQueue revisions_;
  ThingsQueue things_;
  mapping::MapStore store_;
  LineFile trajectory_;
  LineFile localization_log_;
  LineFile changes_;
  LatencyHistogram step_times_;
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
      const CpuTimer timer{report_.cpu.decoding_s};
      const auto replayed = port.next();
      if (!replayed) break;
      decoder.feed(replayed->record, sinks);
      if (!replayed->in_window) continue;
    }
    for (auto& [message, number] : odometry) take(std::move(message), number);
    for (Scan& scan : scans) take(std::move(scan));
    const double done = static_cast<double>(port.read_bytes()) / static_cast<double>(port.size_bytes());
    if (!scans.empty() && !progress(done)) throw std::runtime_error("interrupted");
  }
  report_.cut = port.cut();
  if (report_.scans.decoded == 0) {
    throw std::runtime_error(report_.cut ? report_.cut->text + "; no scan lies before that"
                                         : job_.recording.string() + ": holds no scan in this window");
  }
  report_.wire = decoder.counts();
}

void Replay::take(Odometry&& odometry, std::uint32_t number) {
  ++report_.scans.odometry;
  if (obeys_ && journal_.odometry_was_lost(number)) {
    ++report_.scans.odometry_lost;
    return;
  }
  const CpuTimer timer{report_.cpu.localization_s};
  localization_.observe(odometry);
}

void Replay::take(Scan&& scan) {
  ++report_.scans.decoded;
  if (obeys_ && journal_.was_lost(scan.number)) {
    ++report_.scans.lost;
    return;
  }
  if (obeys_ && journal_.was_dropped(scan.number)) {
    ++report_.scans.dropped;
    trajectory_.write(tum_line(localization_.pass_over(scan)));
    return;
  }
  std::optional<TrackedScan> tracked;
  double cost_s = 0.0;
  {
    const CpuTimer timer{report_.cpu.localization_s};
    while (const auto revision = revisions_.next_before(scan)) localization_.apply(*revision);
    if (auto things = things_.next_before(scan.number)) localization_.apply(std::move(things));
    obey_commands_before(scan);
    tracked = localization_.observe(std::move(scan));
    cost_s = timer.elapsed_s();
    step_times_.add(cost_s);
  }
  ++report_.scans.localized;
  {
    const CpuTimer timer{report_.cpu.recording_s};
    trajectory_.write(tum_line({tracked->scan.time, tracked->estimate.map_from_robot}));
    localization_log_.write(csv_line(localization_.row()));
  }
  if (job_.watch.scan) job_.watch.scan(*tracked, localization_.row(), cost_s);
  if (job_.settings.mapping.enabled && !is_paused_) look_for_changes(*tracked);
}

/// What the operator did is an input as the bytes are: obeyed whatever becomes of the journal.
void Replay::obey_commands_before(const Scan& scan) {
  for (; next_command_ != journal_.commands().end(); ++next_command_) {
    const Decision& command = *next_command_;
    const auto place = journal_.place_of(command, scan);
    if (place > 0) break;
    ++report_.commands;
    const bool is_of_before = !has_begun_ && place < 0;  // the window begins later
    if (command.kind == Decision::Kind::kRelocalized && !is_of_before) localization_.relocalize(command.map_from_robot);
    if (command.kind == Decision::Kind::kMapSet) keep_result(map_.obey(*command.set));
    if (command.kind == Decision::Kind::kPaused) is_paused_ = true;
    if (is_paused_) localization_.apply(std::shared_ptr<const TemporaryThings>{});
    if (command.kind == Decision::Kind::kResumed) is_paused_ = false;
  }
  has_begun_ = true;
}

void Replay::look_for_changes(const TrackedScan& tracked) {
  if (obeys_ && journal_.tracked_was_lost(tracked.scan.number)) {
    ++report_.scans.tracked_lost;
    return;
  }
  std::optional<ScanSet> set;
  {
    const CpuTimer timer{report_.cpu.awareness_s};
    set = store_scan_.observe(tracked);
    things_.push(store_scan_.temporary());
  }
  if (!set) return;
  if (set->withdraw_from) return update_map(*set);
  ++report_.phases;
  const auto closing = journal_.closing_scan(set->phase);
  const bool is_unknown = !closing && is_cut_;
  if (obeys_ && !is_unknown && closing != tracked.scan.number) ++report_.journal_differences;
  if (obeys_ && journal_.set_was_lost(set->phase)) {
    ++report_.scans.sets_lost;
    return;
  }
  update_map(*set);
}

void Replay::update_map(const ScanSet& set) {
  const CpuTimer timer{report_.cpu.map_update_s};
  keep_result(map_.update(set));
}

void Replay::keep_result(MapStep::Result result) {
  changes_.write(json_line(result.note));
  keep(store_, result, map_.method(), first_revision_);
  report_.changes.add(result.note);
  if (job_.watch.change) job_.watch.change(result.revision ? &*result.revision : nullptr, result.note);
  if (!result.revision) return;
  revisions_.push(std::move(*result.revision));
}

RunReport Replay::finish(const std::filesystem::path& out) {
  if (obeys_ && journal_.closed_phases() > report_.phases) {
    report_.journal_differences += static_cast<std::uint32_t>(journal_.closed_phases() - report_.phases);
  }
  trajectory_.flush();
  localization_log_.flush();
  changes_.flush();
  write_grid(*map_.map(), out / "map.yaml");
  report_.time_lost_s = localization_.time_lost_s();
  report_.time_global_s = localization_.time_global_s();
  report_.verdict_times = localization_.verdict_times();
  report_.localizer = localization_.counts();
  report_.recorded_s = localization_.covered_s();
  report_.gate_times = store_scan_.awareness().gate_times;
  report_.latency_of = "localizing one scan, CPU time";
  report_.latency_p50_s = step_times_.quantile_s(0.5);
  report_.latency_p99_s = step_times_.quantile_s(0.99);
  report_.latency_max_s = step_times_.max_s();
  return report_;
}

}  // namespace

RunReport run_replay(const ReplayJob& job, const ReplayProgress& progress) {
  const auto began = std::chrono::steady_clock::now();
  const double began_cpu_s = process_cpu_s();
  auto given = std::make_shared<const OccupancyGrid>(read_grid(job.map));
  require_map_elsewhere(job.map, job.out);
  const RecordedRun recorded = recorded_run(job);
  const ReplayStart begun = replay_start(recorded, job, std::move(given));
  require_pose_on(begun.start.map->geometry(), job.settings);
  StagingFolder staging{job.out};
  RunReport report;
  {
    Replay replay{job, recorded, begun, staging.path()};
    replay.run(progress);
    report = replay.finish(staging.path());
  }
  report.cpu_total_s = process_cpu_s() - began_cpu_s;
  report.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  report.peak_resident_bytes = peak_resident_bytes();
  LineFile file{staging.path() / "report.json"};
  file.write(json_text(report, job.settings));
  file.flush();
  staging.commit();
  return report;
}

}  // namespace deltamap::daemon
