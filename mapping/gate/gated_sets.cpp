// SPDX-License-Identifier: Apache-2.0
#include "mapping/gate/gated_sets.hpp"

#include <utility>

namespace deltamap::mapping::gate {
namespace {

constexpr double kSure = 0.95;  // P(pose right) of a scan that may vote late, were the other hypothesis ruled out

}  // namespace

void GatedSets::observe(const TrackedScan& tracked) {
  now_ = tracked.scan.time;
  other_share_ = tracked.estimate.belief.other_share;
  gate_.observe(tracked);
  if (params_.enabled && gate_.has_proven_wrong()) withdraw(tracked);
}

void GatedSets::withdraw(const TrackedScan& tracked) {
  for (ScanSet& set : waiting_) {
    set.pose_in_doubt = true;
    due_.push_back(std::move(set));
  }
  waiting_.clear();
  const Timestamp from = gate_.settled().value_or(Timestamp::min());
  if (!last_handed_on_ || *last_handed_on_ < from) return;
  last_handed_on_.reset();
  withdrawal_ = {.time = tracked.scan.time, .from = from, .covariance = tracked.estimate.covariance};
}

/// Not where the pose itself may be off or is spread wide: such scans would draw beside what is there.
bool GatedSets::waits_to_vote(const Estimate& estimate) const {
  const GateReason why = gate_.reason();
  const Belief& belief = estimate.belief;
  return !lets_vote() && !gate_.is_distrusted() && belief.pose_right >= kSure * (1.0 - belief.other_share) &&
         (why == GateReason::kConfirming || why == GateReason::kOtherHypothesis);
}

void GatedSets::take(std::optional<ScanSet> set, const TrackedScan& tracked) {
  if (!set) return;
  set->covariance = tracked.estimate.covariance;
  set->pose_in_doubt = params_.enabled && gate_.trusted_since() && set->began < *gate_.trusted_since();
  if (set->pose_in_doubt) {
    due_.push_back(*std::move(set));
  } else {
    waiting_.push_back(*std::move(set));
  }
}

bool GatedSets::is_due(const ScanSet& set) const {
  if (!params_.enabled) return true;
  return gate_.is_open() && other_share_ <= params_.hold_other_share && seconds(now_ - set.ended) >= params_.hold_s;
}

std::optional<MapRequest> GatedSets::next() {
  if (withdrawal_) return std::exchange(withdrawal_, std::nullopt);
  std::optional<ScanSet> set;
  if (!due_.empty()) {
    set = std::move(due_.front());
    due_.pop_front();
  } else if (!waiting_.empty() && is_due(waiting_.front())) {
    set = std::move(waiting_.front());
    waiting_.pop_front();
    last_handed_on_ = set->ended;
  }
  const std::optional<Timestamp> settled = gate_.settled();
  if (set) {
    set->settled = settled;
    return set;
  }
  if (!settled || !last_handed_on_ || *last_handed_on_ >= *settled) return std::nullopt;
  last_handed_on_.reset();
  return Settlement{*settled};
}

}  // namespace deltamap::mapping::gate
