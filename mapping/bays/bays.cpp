// SPDX-License-Identifier: Apache-2.0
#include "mapping/bays/bays.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/pose_spread.hpp"
#include "mapping/bays/bay_verdict.hpp"

namespace deltamap::mapping::bays {
namespace {

constexpr double kLookPeriod_s = 0.18;  // faster scans tell nothing more
constexpr double kFarthest_m = 12.0;    // then beams of 1° lie a cell apart
constexpr double kMostDeviation_m = 0.15;
constexpr double kMostDeviation_rad = 0.035;
constexpr std::uint32_t kWindow_ds = 100;  // what was seen earlier is of another visit
constexpr double kBreak_s = 2.0;           // without a look: a candidate begins anew
constexpr int kLeastLooks = 4;
constexpr double kLasts_s = 0.8;
constexpr double kDoubtLasts_s = 3.0;

/// The beams of a scan that may meet a circle: [first, last).
struct BeamRange {
  std::size_t first = 0;
  std::size_t last = 0;
};

BeamRange beams_towards(const Scan& scan, const Pose2& laser_from_map, const Point2& middle, double radius_m) {
  const Point2 in_laser = laser_from_map * middle;
  const double distance_m = in_laser.norm();
  if (distance_m - radius_m > kFarthest_m) return {};
  const auto beams = static_cast<double>(scan.beams.size());
  if (distance_m <= radius_m) return {0, scan.beams.size()};
  const double half_rad = std::asin(radius_m / distance_m);
  const double bearing_rad = std::atan2(in_laser.y(), in_laser.x());
  const double low = (bearing_rad - half_rad - scan.first_bearing_rad) / scan.bearing_step_rad - 2.0;
  const double high = (bearing_rad + half_rad - scan.first_bearing_rad) / scan.bearing_step_rad + 3.0;
  if (high <= 0.0 || low >= beams) return {};
  return {static_cast<std::size_t>(std::max(0.0, low)), static_cast<std::size_t>(std::min(beams, high))};
}

bool is_sharp(const Estimate& estimate) {
  const PoseDeviation deviation = pose_deviation(estimate.covariance);
  return deviation.position_m <= kMostDeviation_m && deviation.heading_rad <= kMostDeviation_rad;
}

double lasts_s(BayState state) { return state == BayState::kUnknown ? kDoubtLasts_s : kLasts_s; }

}  // namespace

std::string_view name_of(BayState state) {
  constexpr std::string_view kNames[] = {"unknown", "empty", "partly", "full"};
  return kNames[static_cast<std::size_t>(state)];
}

Bays::Bays(std::vector<Bay> bays) : bays_{std::move(bays)}, statuses_(bays_.size()) {
  for (const Bay& bay : bays_) watches_.push_back({.floor = BayFloor{bay.polygon}});
}

void Bays::set(std::vector<Bay> bays) {
  Bays others{std::move(bays)};
  for (std::size_t i = 0; i < others.bays_.size(); ++i) {
    const auto same = std::find_if(bays_.begin(), bays_.end(), [&](const Bay& bay) {
      return bay.id == others.bays_[i].id && bay.polygon == others.bays_[i].polygon;
    });
    if (same == bays_.end()) continue;
    const auto place = static_cast<std::size_t>(same - bays_.begin());
    others.statuses_[i] = statuses_[place];
    others.watches_[i] = watches_[place];
  }
  others.began_ = began_;
  others.looked_ = looked_;
  *this = std::move(others);
}

std::uint32_t Bays::tenths(Timestamp time) const {
  return static_cast<std::uint32_t>(std::lround(10.0 * seconds(time - *began_))) + 1;
}

std::vector<BayEvent> Bays::observe(const TrackedScan& tracked, bool pose_holds) {
  std::vector<BayEvent> events;
  const Timestamp now = tracked.scan.time;
  if (watches_.empty() || !pose_holds || !is_sharp(tracked.estimate)) return events;
  if (looked_ && seconds(now - *looked_) < kLookPeriod_s) return events;
  if (!began_) began_ = now;
  looked_ = now;
  const Pose2 laser_from_map = inverse(tracked.estimate.map_from_robot * tracked.scan.robot_from_laser);
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    BayFloor& floor = watches_[i].floor;
    const BeamRange beams = beams_towards(tracked.scan, laser_from_map, floor.middle(), floor.radius_m());
    if (beams.first >= beams.last) continue;
    floor.look(tracked, beams.first, beams.last, tenths(now));
    judge(i, now, events);
  }
  return events;
}

/// A candidate is what all looks have shown since, without a break.
void Bays::follow(Watch& watch, BayState shown, Timestamp now) {
  const bool goes_on = watch.candidate_looks > 0 && watch.candidate == shown && seconds(now - watch.looked) <= kBreak_s;
  watch.looked = now;
  if (goes_on) {
    ++watch.candidate_looks;
    return;
  }
  watch.candidate = shown;
  watch.candidate_since = now;
  watch.candidate_looks = 1;
}

void Bays::judge(std::size_t bay, Timestamp now, std::vector<BayEvent>& events) {
  Watch& watch = watches_[bay];
  BayStatus& status = statuses_[bay];
  const std::uint32_t now_ds = tenths(now);
  const FloorCounts counts = watch.floor.counts(now_ds, kWindow_ds);
  const std::optional<BayState> shown = shown_state(counts, status.state);
  const bool is_doubted = !shown && contradicts(counts, status.state);
  if (!shown && !is_doubted) {
    watch.candidate_looks = 0;
    return;
  }
  follow(watch, shown.value_or(BayState::kUnknown), now);
  const bool is_new = watch.candidate != status.state;
  if (is_new &&
      (watch.candidate_looks < kLeastLooks || seconds(now - watch.candidate_since) < lasts_s(watch.candidate)))
    return;
  const BayState before = status.state;
  if (is_new) status = {.state = watch.candidate, .seen = status.seen, .since = watch.candidate_since};
  if (shown) {
    // What is full stays so by its faces: those that it shows from another side are of the same load.
    if (is_new || status.state == BayState::kFull) watch.floor.take_as_told();
    const std::uint32_t seen_ds = watch.floor.seen_since_ds(now_ds, kWindow_ds, least_known(counts, status.state));
    const std::uint32_t body_ds = status.state == BayState::kEmpty ? now_ds : watch.floor.body_seen_ds();
    const Timestamp looked_at = now - duration_from_seconds(0.1 * (now_ds - std::min(seen_ds, body_ds)));
    const Timestamp seen = std::max(looked_at, status.since.value_or(looked_at));  // before that it was another state
    status.seen = is_new || !status.seen ? seen : std::max(*status.seen, seen);
    status.share = taken_share(counts);
    status.confidence = confidence_in(counts);
  }
  if (is_new) events.push_back({bays_[bay], before, status, now});
}

std::vector<BayEvent> Bays::forget_since(Timestamp from, Timestamp now) {
  std::vector<BayEvent> events;
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    if (watches_[i].looked < from) continue;
    watches_[i].floor.forget();
    watches_[i].candidate_looks = 0;
    const BayStatus before = statuses_[i];
    if (before.state == BayState::kUnknown || !before.seen || *before.seen < from) continue;
    statuses_[i] = {.state = BayState::kUnknown, .seen = {}, .since = now};
    events.push_back({bays_[i], before.state, statuses_[i], now});
  }
  return events;
}

}  // namespace deltamap::mapping::bays
