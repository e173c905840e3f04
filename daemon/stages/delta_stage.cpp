// SPDX-License-Identifier: Apache-2.0
#include "daemon/stages/delta_stage.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace deltamap::daemon {
namespace {

constexpr std::chrono::seconds kLookAgainAfter{1};
constexpr double kBaysPeriod_s = 0.5;            // of their ages, where no state is another one
constexpr std::size_t kMostWaitingForLook = 64;  // half a minute of them, 8 kB each; the next ones come soon

const ScanSet* set_in(const MapWork& work) {
  const auto* request = std::get_if<MapRequest>(&work);
  return request != nullptr ? std::get_if<ScanSet>(request) : nullptr;
}

}  // namespace

DeltaStage::DeltaStage(const Settings& settings, const StartMap& start, Wiring wiring)
    : wiring_{std::move(wiring)},
      store_scan_{settings.mapping.store_scan, settings.seed, !start.provisional.empty()},
      bays_{start} {
  if (start.site) store_scan_.set_zones(start.site->zones);
  show_bays();
}

void DeltaStage::take(const SharedSite& site) {
  store_scan_.set_zones(site->zones);
  bays_.set_bays(site->bays);
  show_bays();
  hand_over(site);
}

void DeltaStage::run() {
  while (!wiring_.work.is_drained()) {
    pulse_.beat();
    const auto work = wiring_.work.receive_within(kLookAgainAfter);
    if (!work) continue;
    offer_waiting();
    if (const auto* order = std::get_if<MapOrder>(&*work)) {
      hand_over(*order);
    } else if (const auto* site = std::get_if<SharedSite>(&*work)) {
      take(*site);
    } else {
      look_for_changes(std::get<TrackedScan>(*work));
    }
  }
}

void DeltaStage::look_for_changes(const TrackedScan& tracked) {
  std::optional<MapRequest> request = store_scan_.observe(tracked);
  offer_transients();
  const mapping::Awareness& awareness = store_scan_.awareness();
  wiring_.telemetry.r_d.set(tracked.weights.divergence_ratio());
  wiring_.telemetry.in_phase.set(awareness.in_phase);
  wiring_.telemetry.phase.set(awareness.phase);
  wiring_.telemetry.stored_scans.set(awareness.stored_scans);
  tell_of_gate();
  std::vector<mapping::bays::BayEvent> bay_events = bays_.observe(tracked, store_scan_.pose_holds(), request);
  if (request) {
    if (const auto* set = std::get_if<ScanSet>(&*request)) {
      wiring_.telemetry.phases_closed.add(1);
      note({Decision::Kind::kPhaseClosed, tracked.scan.number, set->phase});
    }
    hand_over(*std::move(request));
  }
  show_bays(std::move(bay_events), tracked.scan.time);
  if (thing_looks_.is_due(tracked, store_scan_.pose_holds()) && waiting_.size() < kMostWaitingForLook)
    hand_over(std::make_shared<const TrackedScan>(tracked));
  if (wiring_.shows_scans()) show_scans();
}

/// Their changes go to the map thread behind the scan's set: things and bays are written in one order.
void DeltaStage::show_bays(std::vector<mapping::bays::BayEvent> events, Timestamp now) {
  for (mapping::bays::BayEvent& event : events) hand_over(std::move(event));
  if (events.empty() && seconds(now - bays_shown_) < kBaysPeriod_s) return;
  bays_shown_ = now;
  show_bays();
}

/// Shows the stored scans, with those of sets that still wait for the map thread.
void DeltaStage::show_scans() {
  mapping::StoredScans stored = store_scan_.stored();
  for (const MapWork& work : waiting_) {
    if (const ScanSet* set = set_in(work)) {
      stored.waiting.insert(stored.waiting.end(), set->scans.begin(), set->scans.end());
    }
  }
  wiring_.show_scans(std::move(stored));
}

void DeltaStage::offer_waiting() {
  while (!waiting_.empty() && wiring_.sets.try_send(std::move(waiting_.front()))) waiting_.pop_front();
}

void DeltaStage::offer_transients() {
  const std::shared_ptr<const TransientObstacles>& newest = store_scan_.transients();
  if (newest == nullptr) return;
  if (newest->number != transients_shown_ && wiring_.show(newest)) transients_shown_ = newest->number;
  if (newest->number == transients_sent_) return;
  const std::uint32_t number = newest->number;
  wiring_.telemetry.transients_standing.set(static_cast<std::uint32_t>(newest->standing.size()));
  wiring_.telemetry.transients_gone.set(static_cast<std::uint32_t>(newest->gone.size()));
  if (wiring_.transients.try_send(std::shared_ptr<const TransientObstacles>{newest})) transients_sent_ = number;
}

void DeltaStage::tell_of_gate() {
  const mapping::Awareness& awareness = store_scan_.awareness();
  wiring_.telemetry.gate.set(awareness.gate, awareness.gate_times);
  const LogLine line = gate_watch_.observe(awareness);
  if (!line.text.empty()) (line.is_warning ? wiring_.warn : wiring_.log)(line.text);
}

/// Hands work to the map thread. One set of scans waits at most and the next is lost; orders and settlements always
/// wait: an operator gives few orders, and each settlement follows a set.
void DeltaStage::hand_over(MapWork work) {
  const ScanSet* set = set_in(work);
  if (set != nullptr && std::any_of(waiting_.begin(), waiting_.end(), set_in)) {
    wiring_.telemetry.sets_lost.add(1);
    note({Decision::Kind::kSetLost, 0, set->phase});
    return;
  }
  waiting_.push_back(std::move(work));
  offer_waiting();
}

}  // namespace deltamap::daemon
