// SPDX-License-Identifier: Apache-2.0
#include "daemon/stages/localization_stage.hpp"

#include <chrono>
#include <cstdio>
#include <utility>
#include <vector>

#include "daemon/steps/run_begin.hpp"
#include "drivers/port/port_clock.hpp"

namespace deltamap::daemon {
namespace {

using Kind = Decision::Kind;

constexpr double kStabilityPeriods = 12.0;            // stability is written once in so many writings of the pose
constexpr double kNoScan_s = 0.7;                     // without a scan, then commands are answered as not done
constexpr std::chrono::milliseconds kLookEvery{200};  // for commands, while no message comes

/// Nothing where the command does not concern the map.
std::optional<MapOrder::Kind> map_order_of(control::Command::Kind kind) {
  switch (kind) {
    case control::Command::Kind::kUndo:
      return MapOrder::Kind::kUndo;
    case control::Command::Kind::kRollBack:
      return MapOrder::Kind::kRollBack;
    case control::Command::Kind::kUndoThing:
      return MapOrder::Kind::kUndoThing;
    default:
      return std::nullopt;
  }
}

std::optional<std::size_t> newest_scan_in(const std::vector<SensorMessage>& batch) {
  for (std::size_t i = batch.size(); i-- > 0;) {
    if (std::holds_alternative<Scan>(batch[i])) return i;
  }
  return std::nullopt;
}

/// True where the period is over, and where the clock has jumped back.
bool is_due(const std::optional<Timestamp>& last, Timestamp time, double period_s) {
  return !last || time < *last || seconds(time - *last) >= period_s;
}

}  // namespace

LocalizationStage::LocalizationStage(const Settings& settings, const StartMap& start, std::uint64_t first_map,
                                     Wiring wiring)
    : wiring_{std::move(wiring)},
      step_{settings, start},
      pilot_{settings, start.site ? start.site->zones : Zones{}},
      mapping_enabled_{settings.mapping.enabled},
      first_revision_{start.revision},
      first_map_{first_map},
      map_{start.map},
      memory_{settings.memory},
      is_kept_{!settings.map.store.empty()},
      wants_checkpoints_{has_checkpoints(settings)} {
  if (start.site && *start.site != Site{}) note({0, {}, start.site});
  if (settings.initial_pose && step_.counts().at("poses_refused") > 0) {
    (void)wiring_.recorder.try_send(refused_start_line());
  }
}

void LocalizationStage::run() {
  std::vector<SensorMessage> batch;
  batch.reserve(wiring_.sensors.capacity());
  last_scan_came_ = drivers::port::port_clock_now();
  while (!wiring_.sensors.is_drained()) {
    pulse_.beat();
    auto message = wiring_.sensors.receive_within(kLookEvery);
    while (const auto params = wiring_.wander.try_receive()) pilot_.set_params(*params);
    hear_of_sites();
    // After a stall the queue is drained: all odometry counts, of the scans only the newest.
    batch.clear();
    while (message) {
      batch.push_back(std::move(*message));
      message = batch.size() < wiring_.sensors.capacity() ? wiring_.sensors.try_receive() : std::nullopt;
    }
    // A stage that stood still took no message meanwhile: the waiting ones are looked at before the laser is called
    // silent.
    const bool is_silent = seconds(drivers::port::port_clock_now() - last_scan_came_) >= kNoScan_s;
    if (is_silent && !newest_scan_in(batch)) take_commands_without_scan();
    work_off(batch);
  }
  if (!pose_kept_) return;
  keep_pose();
  keep_stability();
}

void LocalizationStage::work_off(std::vector<SensorMessage>& batch) {
  const auto newest_scan = newest_scan_in(batch);
  for (std::size_t i = 0; i < batch.size(); ++i) {
    if (const auto* odometry = std::get_if<Odometry>(&batch[i])) {
      step_.observe(*odometry);
    } else if (i == newest_scan) {
      localize(std::move(std::get<Scan>(batch[i])));
    } else {
      pass_over(std::get<Scan>(batch[i]));
    }
  }
}

void LocalizationStage::pass_over(const Scan& scan) {
  wiring_.telemetry.dropped.add(1);
  note({Kind::kScanDropped, scan.number, 0});
  (void)wiring_.recorder.try_send(step_.pass_over(scan));
}

void LocalizationStage::localize(Scan scan) {
  last_scan_came_ = drivers::port::port_clock_now();
  const std::uint32_t number = scan.number;
  take_revisions(number);
  take_transients(number);
  take_sites(scan);
  take_commands(scan);
  TrackedScan tracked = step_.observe(std::move(scan));
  answer_relocalize(number);
  pilot(tracked);
  show(tracked.estimate, tracked.scan.received);
  wiring_.show(tracked, step_.row(), wiring_.telemetry.latency_s.value(), step_.particles());
  tell_changes();
  for (const LogLine& line : step_.lines()) (void)wiring_.recorder.try_send(LogLine{line});
  (void)wiring_.recorder.try_send(TrajectoryPoint{tracked.scan.time, tracked.estimate.map_from_robot});
  (void)wiring_.recorder.try_send(std::make_unique<const LocalizationRow>(step_.row()));
  map_ = tracked.estimate.map;
  keep_now_and_then(tracked.scan.time);
  if (!mapping_enabled_ || is_paused_ || wiring_.tracked_scans.try_send(std::move(tracked))) return;
  wiring_.telemetry.tracked_lost.add(1);
  note({Kind::kTrackedLost, number, 0});
}

void LocalizationStage::take_revisions(std::uint32_t scan) {
  while (const auto revision = wiring_.revisions.try_receive()) {
    step_.apply(*revision);
    // The journal counts revisions from the start of the run, as a replay does.
    note({Kind::kRevision, scan, revision->number - first_revision_});
  }
}

void LocalizationStage::take_transients(std::uint32_t scan) {
  std::shared_ptr<const TransientObstacles> newest;
  while (auto transients = wiring_.transients.try_receive()) newest = std::move(*transients);
  if (newest == nullptr || is_paused_) return;
  note({Kind::kTransients, scan, newest->number});
  transients_ = newest;
  step_.apply(std::move(newest));
}

void LocalizationStage::pilot(const TrackedScan& tracked) {
  const PilotWord word = pilot_.observe(tracked, {.fit = step_.fit(),
                                                  .start_fits = step_.start_fits(),
                                                  .transients = transients_.get(),
                                                  .times_let_drive = wiring_.telemetry.times_let_drive.value()});
  wiring_.telemetry.pose_stop.set(static_cast<std::uint8_t>(word.pose));
  wiring_.telemetry.wanted_speed_m_per_s.set(word.command.speed_m_per_s);
  wiring_.telemetry.wanted_turn_rate_rad_per_s.set(word.command.turn_rate_rad_per_s);
  wiring_.drive(word);
}

// --- the operator ---

/// Also while no scan comes: who draws meanwhile is not told that the daemon is busy.
void LocalizationStage::hear_of_sites() {
  while (auto site = wiring_.sites.try_receive()) site_to_take_ = *std::move(site);
}

void LocalizationStage::take_sites(const Scan& scan) {
  hear_of_sites();
  if (site_to_take_) {
    step_.set_zones(site_to_take_->zones);
    pilot_.set_zones(site_to_take_->zones);
    note({scan.number, scan.time, site_to_take_});
    site_to_hand_on_ = std::exchange(site_to_take_, nullptr);
  }
  if (site_to_hand_on_ && wiring_.tracked_scans.try_send(SharedSite{site_to_hand_on_})) site_to_hand_on_.reset();
}

void LocalizationStage::note(const SetSite& set) {
  for (std::string& part : notes_of(set)) (void)wiring_.recorder.try_send(std::move(part));
}

void LocalizationStage::take_commands(const Scan& scan) {
  while (const auto command = wiring_.commands.try_receive()) {
    if (command->kind == control::Command::Kind::kSave) {
      save(*command);
    } else if (command->kind == control::Command::Kind::kRelocalize) {
      relocalize(*command, scan);
    } else if (const auto kind = map_order_of(command->kind)) {
      order_map(*command, *kind, scan);
    } else {
      pause(*command, scan);
    }
  }
}

void LocalizationStage::take_commands_without_scan() {
  while (const auto command = wiring_.commands.try_receive()) {
    if (command->kind == control::Command::Kind::kSave) {
      save(*command);
      continue;
    }
    const double silent_s = seconds(drivers::port::port_clock_now() - last_scan_came_);
    char text[96];
    (void)std::snprintf(text, sizeof text, "not done: no scan has come for %.0f s; look at the laser", silent_s);
    wiring_.answer({command->ticket, false, text});
  }
}

void LocalizationStage::relocalize(const control::Command& command, const Scan& scan) {
  if (relocalized_) wiring_.answer({*relocalized_, false, "another pose has come before the next scan"});
  relocalized_.reset();
  if (!step_.relocalize(command.map_from_robot)) {
    return wiring_.answer({command.ticket, false, "no free floor lies within 1 m of it: the pose stays as it was"});
  }
  note({Kind::kRelocalized, scan.number, 0, command.map_from_robot, scan.time});
  relocalized_ = command.ticket;
}

void LocalizationStage::answer_relocalize(std::uint32_t scan) {
  if (!relocalized_) return;
  wiring_.answer({*relocalized_, true,
                  "the robot starts there with scan " + std::to_string(scan) + ": " + fit_words(step_.fit()),
                  is_in_doubt(step_.fit())});
  relocalized_.reset();
}

void LocalizationStage::order_map(const control::Command& command, MapOrder::Kind kind, const Scan& scan) {
  if (!mapping_enabled_) {
    return wiring_.answer({command.ticket, false, "'mapping.enabled' is false: nobody works on the map"});
  }
  MapOrder order;
  order.kind = kind;
  order.revision = command.revision;
  order.thing = command.thing;
  order.scan = scan.number;
  order.scan_time = scan.time;
  order.ticket = command.ticket;
  if (wiring_.tracked_scans.try_send(order)) return;
  wiring_.answer({command.ticket, false, "not done: too many scans wait for Δ-mapping, try again"});
}

void LocalizationStage::pause(const control::Command& command, const Scan& scan) {
  const std::string from = " from scan " + std::to_string(scan.number) + " on";
  if (!mapping_enabled_)
    return wiring_.answer({command.ticket, false, "'mapping.enabled' is false: there is nothing to pause"});
  is_paused_ = command.kind == control::Command::Kind::kPause;
  wiring_.telemetry.paused.set(is_paused_);
  if (is_paused_) {  // a paused Δ-stage would not notice that a transient obstacle leaves
    transients_.reset();
    step_.apply(transients_);
  }
  note({is_paused_ ? Kind::kPaused : Kind::kResumed, scan.number, 0, {}, scan.time});
  wiring_.answer({command.ticket, true, (is_paused_ ? "the map stays as it is" : "the map follows the world") + from});
}

/// Sends pose and map to the recorder, which answers the operator when both are on disk.
void LocalizationStage::save(const control::Command& command) {
  if (!pose_kept_) {
    wiring_.answer({command.ticket, false, "no scan has been localized yet: nothing to save"});
  } else if (!wiring_.recorder.try_send(
                 std::make_unique<const SaveOrder>(SaveOrder{command.ticket, pose_to_keep(), map_}))) {
    wiring_.answer({command.ticket, false, "the disk is too slow: try again"});
  }
}

// --- what others see ---

void LocalizationStage::show(const Estimate& estimate, Timestamp received) {
  const double latency_s = seconds(drivers::port::port_clock_now() - received);
  latency_.add(latency_s);
  wiring_.telemetry.localized.add(1);
  wiring_.telemetry.fit.set(step_.fit().value_or(-1.0));
  wiring_.telemetry.calibration.set(step_.calibration());
  wiring_.telemetry.latency_s.set(latency_s);
  wiring_.telemetry.estimate.set(estimate);
}

void LocalizationStage::tell_changes() {
  const LocalizationRow& row = step_.row();
  if (row.state != told_state_) {
    (void)wiring_.recorder.try_send(LogLine{state_line(row)});
    told_state_ = row.state;
  }
  if (row.belief.verdict != told_verdict_) {
    (void)wiring_.recorder.try_send(LogLine{verdict_line(row)});
    told_verdict_ = row.belief.verdict;
  }
}

// --- what outlives the run ---

void LocalizationStage::keep_now_and_then(Timestamp time) {
  has_tracked_ = has_tracked_ || step_.row().state == LocalizerState::kTracking;
  if (is_due(pose_kept_, time, memory_.pose_period_s)) {
    pose_kept_ = time;
    keep_pose();
  }
  if (wants_checkpoints_ && is_due(checked_, time, kCheckpointPeriodS)) {
    checked_ = time;
    send_checkpoint();
  }
  if (!stability_kept_) stability_kept_ = time;  // the first write comes a period later
  if (is_due(stability_kept_, time, kStabilityPeriods * memory_.pose_period_s)) {
    stability_kept_ = time;
    keep_stability();
  }
}

void LocalizationStage::keep_pose() {
  if (is_kept_ && has_tracked_) (void)wiring_.recorder.try_send(std::make_unique<const KeptPose>(pose_to_keep()));
}

void LocalizationStage::keep_stability() {
  if (!is_kept_) return;
  (void)wiring_.recorder.try_send(std::make_unique<const KeptStability>(
      KeptStability{.first_map = first_map_, .revision = step_.row().revision, .record = step_.stability()}));
}

void LocalizationStage::send_checkpoint() {
  (void)wiring_.recorder.try_send(std::make_shared<const Checkpoint>(checkpoint_of(step_, first_map_, map_)));
}

KeptPose LocalizationStage::pose_to_keep() const { return kept_pose_of(step_.row(), first_map_, step_.calibration()); }

}  // namespace deltamap::daemon
