// SPDX-License-Identifier: Apache-2.0
#include "mapping/gate/write_gate.hpp"

#include <algorithm>
#include <numeric>

#include "core/geometry/pose_spread.hpp"

namespace deltamap::mapping::gate {
namespace {

/// The pose that is believed afterwards may lie anywhere.
bool may_be_another(GateReason reason) { return reason == GateReason::kSearching || reason == GateReason::kLost; }

}  // namespace

std::string_view name_of(GateReason reason) {
  switch (reason) {
    case GateReason::kOpen:
      return "open";
    case GateReason::kSearching:
      return "searching";
    case GateReason::kLost:
      return "lost";
    case GateReason::kWrong:
      return "wrong";
    case GateReason::kRelocalized:
      return "relocalized";
    case GateReason::kDisbelieved:
      return "disbelieved";
    case GateReason::kConfirming:
      return "confirming";
    case GateReason::kDoubtful:
      return "doubtful";
    case GateReason::kOtherHypothesis:
      return "rival";
    case GateReason::kSpread:
      return "spread";
    case GateReason::kWheels:
      return "wheels";
    case GateReason::kMount:
      return "mount";
    case GateReason::kScale:
      return "scale";
  }
  return "?";
}

bool proves_wrong(GateReason reason) {
  return reason == GateReason::kSearching || reason == GateReason::kLost || reason == GateReason::kWrong ||
         reason == GateReason::kRelocalized || reason == GateReason::kDisbelieved;
}

double observed_s(const GateTimes& times) { return std::accumulate(times.begin(), times.end(), 0.0); }
double shut_s(const GateTimes& times) { return observed_s(times) - times[static_cast<std::size_t>(GateReason::kOpen)]; }

std::map<std::string, double> shut_by_reason(const GateTimes& times) {
  std::map<std::string, double> shut;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto reason = static_cast<GateReason>(i);
    if (reason != GateReason::kOpen && times[i] > 0.0) shut[std::string{name_of(reason)}] = times[i];
  }
  return shut;
}

namespace {

/// Nothing where the sensors are as believed.
std::optional<GateReason> reason_of(SensorDoubt doubt) {
  switch (doubt) {
    case SensorDoubt::kWheels:
      return GateReason::kWheels;
    case SensorDoubt::kMount:
      return GateReason::kMount;
    case SensorDoubt::kScale:
      return GateReason::kScale;
    case SensorDoubt::kNone:
      break;
  }
  return std::nullopt;
}

}  // namespace

bool WriteGate::was_relocalized(const Estimate& estimate) {
  const bool is_new = relocalizations_ && *relocalizations_ != estimate.relocalizations;
  relocalizations_ = estimate.relocalizations;
  return is_new;
}

GateReason WriteGate::judged(const TrackedScan& tracked) {
  const Estimate& estimate = tracked.estimate;
  const bool relocalized = was_relocalized(estimate);
  if (estimate.state == LocalizerState::kGlobal) return GateReason::kSearching;
  if (estimate.state == LocalizerState::kLost) return GateReason::kLost;
  if (estimate.belief.verdict == PoseVerdict::kWrong) return GateReason::kWrong;
  if (relocalized) return GateReason::kRelocalized;
  if (estimate.belief.pose_right < params_.disbelieved_below) return GateReason::kDisbelieved;
  if (const auto doubt = reason_of(tracked.sensor_doubt)) return *doubt;
  if (estimate.belief.other_share > params_.most_other_share) return GateReason::kOtherHypothesis;
  if (estimate.belief.pose_right < params_.least_pose_right) return GateReason::kDoubtful;
  const bool is_held = estimate.belief.is_carried ||
                       estimate.belief.stable.expected + estimate.belief.elsewhere.expected >= params_.least_expected;
  if (!is_held || widest_deviation_m(estimate.noise_covariance()) > params_.most_deviation_m)
    return GateReason::kSpread;
  return GateReason::kOpen;
}

double DrivenWay::since_last_m(const TrackedScan& tracked) {
  const bool follows = last_ && epoch_ == tracked.odometry_epoch;
  const double way_m = follows ? distance_between(*last_, tracked.odom_from_robot) : 0.0;
  last_ = tracked.odom_from_robot;
  epoch_ = tracked.odometry_epoch;
  return way_m;
}

/// The estimate of a robot that has been carried goes on as if nothing had been.
void WriteGate::note_break(const TrackedScan& tracked) {
  const Belief& belief = tracked.estimate.belief;
  const bool breaks_off = belief.broke_off_at != broke_off_at_;
  broke_off_at_ = belief.broke_off_at;
  if (is_confirming_) {
    if (breaks_off) held_s_ = held_m_ = 0.0;  // whoever was carried once may be carried again
    return;
  }
  if (!belief.fits_worse) return;
  is_confirming_ = true;
  confirms_after_ = GateReason::kConfirming;
}

bool WriteGate::breaks_now(Timestamp time) const {
  if (!broke_off_at_) return false;
  const double since_s = seconds(time - *broke_off_at_);
  return since_s >= 0.0 && since_s <= params_.break_settles_s;
}

/// Has the pose held for long and far enough? A moment of doubt only holds that up; a proof that the pose was wrong
/// takes back all that has spoken for it.
bool WriteGate::holds(GateReason judgement, bool fits_worse, double passed_s, double driven_m) {
  if (proves_wrong(judgement)) {
    held_s_ = held_m_ = 0.0;
  } else if (judgement == GateReason::kOpen && !fits_worse) {
    held_s_ += passed_s;
    held_m_ += driven_m;
  }
  const bool was_found = may_be_another(confirms_after_);
  return held_s_ >= (was_found ? params_.confirm_s : params_.confirm_followed_s) &&
         held_m_ >= (was_found ? params_.confirm_m : params_.confirm_followed_m);
}

void WriteGate::observe(const TrackedScan& tracked) {
  const Timestamp time = tracked.scan.time;
  const double passed_s = last_ ? std::max(0.0, seconds(time - *last_)) : 0.0;
  if (last_) {
    times_[static_cast<std::size_t>(reason_)] += passed_s;
    shut_for_s_ = is_open() ? 0.0 : shut_for_s_ + passed_s;
  }
  last_ = time;
  const double driven_m = driven_way_.since_last_m(tracked);
  const GateReason judgement = judged(tracked);
  note_break(tracked);
  // Of a pose that the run before has left nothing is known until it has been held against the first scans.
  const bool was_believed = was_tracking_ || (inherits_ && !tracked.estimate.checks_pose);
  const bool is_proof = proves_wrong(judgement);
  has_proven_wrong_ = was_believed && !is_distrusted_ && is_proof;
  if (has_proven_wrong_) is_distrusted_ = true;
  if (tracked.estimate.state == LocalizerState::kTracking) was_tracking_ = true;
  if ((was_tracking_ || was_believed) && is_proof) {
    // What a search has found remains found, whatever else speaks against it.
    if (!is_confirming_ || !may_be_another(confirms_after_)) confirms_after_ = judgement;
    is_confirming_ = true;
  }
  if (is_confirming_ && holds(judgement, tracked.estimate.belief.fits_worse, passed_s, driven_m)) {
    is_confirming_ = false;
    held_s_ = held_m_ = 0.0;
  }
  const bool confirms = is_confirming_ || breaks_now(time);
  reason_ = confirms && judgement == GateReason::kOpen ? GateReason::kConfirming : judgement;
  if (is_open() && is_distrusted_) {
    is_distrusted_ = false;
    trusted_since_ = time;
  }
  if (is_open()) shut_for_s_ = 0.0;
  provisional_.observe(time, is_open() ? passed_s : 0.0, is_open() ? driven_m : 0.0);
}

}  // namespace deltamap::mapping::gate
