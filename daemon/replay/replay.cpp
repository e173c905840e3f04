// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/replay.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <memory>
#include <stdexcept>
#include <utility>

#include "daemon/telemetry/cpu_timer.hpp"

namespace deltamap::daemon {

Replay::Replay(const Parts& parts, const RunDuties& duties)
    : job_{parts.job},
      journal_{parts.recorded.journal},
      source_{parts.source},
      output_{parts.output},
      lacks_end_{parts.recorded.faults.lacks_end},
      obeys_{parts.begun.journal == "obeyed"},
      tells_times_{duties.tells_times},
      next_command_{journal_.commands().begin()},
      run_{job_.settings, parts.begun.start, obeys_ ? &journal_ : nullptr, job_.map_delay_s, duties} {
  report_.began = parts.begun.began;
  report_.journal = parts.begun.journal;
}

void Replay::run(const ReplayProgress& progress) {
  const CpuTimer timer{run_cpu_s_, tells_times_};
  while (auto next = source_.next()) {
    if (const auto* odometry = std::get_if<Odometry>(&next->message)) {
      take(*odometry, next->number);
      continue;
    }
    take(std::get<Scan>(std::move(next->message)));
    if (!progress(source_.done())) throw std::runtime_error("interrupted");
  }
  report_.recording = source_.faults();
  report_.outside_window = source_.outside_window();
  if (report_.scans.decoded == 0) throw std::runtime_error(why_no_scan(report_.recording, job_.recording));
  report_.wire = source_.wire();
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
    output_.passed_over(run_.localization().pass_over(scan));
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
    const CpuTimer timer{recording_cpu_s_, tells_times_};
    output_.localized(row);
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
    if (command.kind == Decision::Kind::kSiteSet) run_.take(site_to_take(*command.site));
    if (command.kind == Decision::Kind::kPaused) is_paused_ = true;
    if (is_paused_) run_.localization().apply(std::shared_ptr<const TransientObstacles>{});
    if (command.kind == Decision::Kind::kResumed) is_paused_ = false;
  }
  has_begun_ = true;
}

/// Bays that this replay was given are judged, whichever the recorded run had.
Site Replay::site_to_take(const Site& recorded) const {
  return job_.settings.bays.file.empty() ? recorded : Site{run_.bays().list()->bays, recorded.zones};
}

void Replay::look_for_changes(const TrackedScan& tracked) {
  if (obeys_ && journal_.tracked_was_lost(tracked.scan.number)) {
    ++report_.scans.tracked_lost;
    return;
  }
  const std::optional<MapRequest> request = run_.look_for_changes(tracked);
  if (request) update_map(*request, tracked.scan.number);
  for (const mapping::bays::BayEvent& event : run_.bay_events()) output_.told(event);
  if (thing_looks_.is_due(tracked, run_.store_scan().pose_holds())) output_.look(tracked);
  if (job_.watch.bays) job_.watch.bays(run_.bays(), tracked.scan.time);
}

void Replay::update_map(const MapRequest& request, std::uint32_t scan) {
  if (const auto* set = std::get_if<ScanSet>(&request); set != nullptr && !reaches_map(*set, scan)) return;
  if (const auto result = run_.update_map(request)) return keep_result(*result);
  output_.settled();
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
  output_.changed(result, run_.map().method());
  report_.changes.add(result.note);
  if (job_.watch.change) job_.watch.change(result.revision ? &*result.revision : nullptr, result.note);
}

RunReport Replay::finish() {
  if (obeys_ && journal_.closed_phases() > report_.phases) {
    report_.journal_differences += static_cast<std::uint32_t>(journal_.closed_phases() - report_.phases);
  }
  output_.finish(*run_.map().map());
  add_to(report_, run_.localization());
  report_.gate_times = run_.store_scan().awareness().gate_times;
  report_.cpu = run_.cpu();
  report_.cpu.recording_s = recording_cpu_s_;
  report_.cpu.decoding_s = std::max(0.0, run_cpu_s_ - report_.cpu.sum_s());
  report_.latency_of = "localizing one scan, CPU time";
  return report_;
}

}  // namespace deltamap::daemon
