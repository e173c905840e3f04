// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/alias_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "localization/hypotheses/global_search.hpp"
#include "localization/hypotheses/hypothesis_report.hpp"

namespace deltamap::localization::hypotheses {
namespace {

constexpr int kRightAngles = 4;

}  // namespace

AliasMonitor::AliasMonitor(const Effort& effort) : effort_{effort}, lattice_{kRightAngles} {}

void AliasMonitor::observe(const Seen& seen) {
  bank_.believe(seen.map_from_believed);
  own_fit_ = mean_log_likelihood(seen.field, seen.ends, seen.map_from_believed);
  bank_.refine_others(seen.field, seen.ends, static_cast<std::size_t>(std::max(0, effort_.refined)), seen.unknown_s);
  if (!seen.weights.empty()) bank_.weigh(seen.field, seen.ends, seen.weights, seen.evidence_weight);
  probe(seen);
  bank_.settle();
}

void AliasMonitor::probe(const Seen& seen) {
  const double heading_rad = seen.map_from_believed.theta;
  const auto c = static_cast<float>(std::cos(heading_rad));
  const auto s = static_cast<float>(std::sin(heading_rad));
  const std::size_t count = seen.near_ends.size();
  turned_.range_deviation_m = seen.near_ends.range_deviation_m;
  turned_.x_m.resize(count);
  turned_.y_m.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    turned_.x_m[i] = c * seen.near_ends.x_m[i] - s * seen.near_ends.y_m[i];
    turned_.y_m[i] = s * seen.near_ends.x_m[i] + c * seen.near_ends.y_m[i];
  }
  lattice_.look(seen.coarse, turned_, static_cast<std::size_t>(std::max(0, effort_.probes)));
  for (const Candidate& candidate : lattice_.best_apart(1)) {
    if (!may_reach(candidate, own_fit_ - kFitsNearlyAsWell)) continue;
    const Pose2& at = candidate.map_from_robot;
    admit({at.x, at.y, wrapped_angle(at.theta + heading_rad)}, seen);
  }
}

void AliasMonitor::admit(const Pose2& rough, const Seen& seen) {
  const Pose2 pose = settled(seen.field, seen.ends, rough);
  if (bank_.knows(pose) || is_nearby(pose, seen.map_from_believed)) return;
  if (mean_log_likelihood(seen.field, seen.ends, pose) < own_fit_ - kFitsNearlyAsWell) return;
  const Comparison lately = seen.stack.compared_lately(
      seen.field, pose, seen.map_from_believed, seen.continuous_odom_from_robot, HypothesisBank::kEvidenceOfABeam);
  bank_.admit({.map_from_robot = pose,
               .log_evidence = bank_.hypotheses().front().log_evidence + lately.ahead(),
               .log_prior = std::log(effort_.prior),
               .since_kidnapping = seen.evidence_weight * lately.ahead(),
               .lost_since = seen.evidence_weight * lately.lost});
}

}  // namespace deltamap::localization::hypotheses
