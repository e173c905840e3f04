// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/hypothesis_report.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace deltamap::localization::hypotheses {
namespace {

constexpr double kAroundM = 0.6;    // hypotheses that the next scans may join
constexpr double kLostAgain = 2.0;  // what was lost counts so often more

/// For a hypothesis where the robot may have been carried. There nearly all beams end as expected; where many do not
/// that fit the believed pose it is chance that has found it.
double says(const PoseHypothesis& hypothesis) {
  return std::max(0.0, hypothesis.since_kidnapping - kLostAgain * hypothesis.lost_since);
}

/// Among the best others, where it belongs there.
void list(const PoseHypothesis& hypothesis, HypothesisReport& report) {
  ReportedHypothesis entry{hypothesis.map_from_robot, hypothesis.share, 0.0, hypothesis.followed_m};
  for (std::size_t rank = 0; rank < report.listed; ++rank) {
    if (entry.share > report.others[rank].share) std::swap(entry, report.others[rank]);
  }
  if (report.listed < HypothesisReport::kListed) report.others[report.listed++] = entry;
}

}  // namespace

double share_around(const HypothesisBank& bank, const Pose2& pose) {
  double share = 0.0;
  for (const PoseHypothesis& hypothesis : bank.others()) {
    if (is_within(hypothesis.map_from_robot, pose, kAroundM, kNearbyRad)) share += hypothesis.share;
  }
  return share;
}

HypothesisReport report_on(const HypothesisBank& bank, const HypothesisBank& watched, const ReportRules& rules) {
  HypothesisReport report;
  report.own_known = bank.believing();
  report.followed = bank.hypotheses().size();
  double squared_shares = 0.0;
  for (const PoseHypothesis& hypothesis : bank.hypotheses()) squared_shares += hypothesis.share * hypothesis.share;
  report.effective_hypotheses = squared_shares > 0.0 ? 1.0 / squared_shares : 1.0;
  for (const PoseHypothesis& hypothesis : bank.others()) list(hypothesis, report);
  for (std::size_t i = 0; i < report.listed; ++i) {
    report.others[i].share_around = share_around(bank, report.others[i].map_from_robot);
  }
  if (!report.own_known || report.followed == 0) return report;

  const PoseHypothesis& own = bank.hypotheses().front();
  report.own_share = own.share;
  for (const PoseHypothesis& hypothesis : bank.others()) {
    const double ahead = hypothesis.log_evidence - own.log_evidence;
    if (ahead <= rules.beats_by || hypothesis.followed_m < kWinsAfterM) continue;
    report.beaten = true;
    report.beaten_for_m = std::max(report.beaten_for_m, hypothesis.followed_m);
  }
  const PoseHypothesis* kidnapped = nullptr;
  for (const HypothesisBank* hypotheses : {&bank, &watched}) {
    for (const PoseHypothesis& hypothesis : hypotheses->others()) {
      if (is_nearby(hypothesis.map_from_robot, own.map_from_robot)) continue;
      if (kidnapped == nullptr || says(hypothesis) > says(*kidnapped)) kidnapped = &hypothesis;
    }
  }
  if (kidnapped == nullptr || says(*kidnapped) <= 0.0) return report;
  report.kidnapped_share = rules.kidnapped_now_prior / (rules.kidnapped_now_prior + std::exp(-says(*kidnapped)));
  report.map_from_kidnapped = kidnapped->map_from_robot;
  return report;
}

}  // namespace deltamap::localization::hypotheses
