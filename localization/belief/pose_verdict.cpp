// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/pose_verdict.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace deltamap::localization::belief {
namespace {

constexpr double kOtherView = 0.25;    // a support that has changed so much is a new view, whatever odometry says
constexpr double kBeamsOfDoubt = 3.0;  // few beams leave the support near one half
constexpr double kLeastProven = 0.25;  // what unproven tiles may say against a pose
constexpr double kMapMemoryViews = 3.0;
constexpr double kMapSteepness = 22.0;  // log-odds a unit of the share of beams off the map

double probability(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }
double log_odds(double probability) { return std::log(probability / (1.0 - probability)); }

/// Share of the beams that support the pose in a direction; nothing where too few tell of it.
std::optional<double> support_along(const Support& stable, const Support& elsewhere, const PoseVerdictParams& params) {
  const double others = params.unproven_weight;
  if (stable.expected() + others * elsewhere.expected() < params.least_beams) return std::nullopt;
  return (stable.fit + others * elsewhere.fit + 0.5 * kBeamsOfDoubt) /
         (stable.expected() + others * elsewhere.expected() + kBeamsOfDoubt);
}

/// Do proven tiles tell of the pose in both directions?
bool is_proof(const ViewTally& view, const PoseVerdictParams& params) {
  return view.stable_along[0].expected() >= params.least_beams && view.stable_along[1].expected() >= params.least_beams;
}

/// ln p(support | right) - ln p(support | wrong) of one new view, halved because views of one drive are alike. From
/// drives in the paper's hall at right poses (unchanged, 10 %, 50 % changed) and wrong ones;
/// docs/decisions/pose-verdict.md.
double evidence_of(double support) {
  constexpr std::array<double, 11> kByTenths{-2.6, -2.6, -2.0, -1.1, -0.2, 0.25, 0.5, 0.75, 1.0, 1.2, 1.2};
  const double at = 10.0 * std::clamp(support, 0.0, 1.0);
  const std::size_t below = std::min<std::size_t>(9, static_cast<std::size_t>(at));
  const double share = at - static_cast<double>(below);
  return kByTenths[below] + share * (kByTenths[below + 1] - kByTenths[below]);
}

/// What the weaker direction says, and how well it supports the pose; what has not proven to stay speaks little against
/// it.
struct Weakest {
  double support = 0.0;
  double evidence = 0.0;
};
std::optional<Weakest> weakest_direction(const ViewTally& view, const PoseVerdictParams& params) {
  std::optional<Weakest> weakest;
  for (std::size_t i = 0; i < view.stable_along.size(); ++i) {
    const Support& stable = view.stable_along[i];
    const Support& elsewhere = view.elsewhere_along[i];
    const std::optional<double> support = support_along(stable, elsewhere, params);
    if (!support) continue;
    const double proven_share = stable.expected() / (stable.expected() + elsewhere.expected());
    const double evidence = evidence_of(*support);
    const Weakest found{*support, evidence < 0.0 ? evidence * std::max(kLeastProven, proven_share) : evidence};
    if (!weakest || found.evidence < weakest->evidence) weakest = found;
  }
  return weakest;
}

}  // namespace

void PoseJudge::start(double pose_right) {
  right_log_odds_ = log_odds(std::clamp(pose_right, params_.least_wrong, 1.0 - params_.least_wrong));
  proof_ = 0.0;
  shares_ = {};
  any_view_ = false;
  last_support_.reset();
  belief_ = {};
  trust_ = belief_.pose_right = pose_right;
}

double PoseJudge::novelty(const Passed& passed, std::optional<double> support) {
  const bool other = support && last_support_ && std::abs(*support - *last_support_) > kOtherView;
  last_support_ = support;
  if (other || !any_view_) return 1.0;
  return std::min(
      1.0, passed.driven_m / params_.view_m + passed.turned_rad / params_.view_rad + passed.time_s / params_.view_s);
}

void PoseJudge::observe(const ViewTally& view, const Passed& passed, const Shares& shares) {
  belief_.stable = view.stable;
  belief_.elsewhere = view.elsewhere;
  shares_ = shares;
  belief_.other_share = shares.best_other;
  belief_.map_from_other = shares.map_from_other;

  const std::optional<Weakest> weakest = weakest_direction(view, params_);
  const bool proven = is_proof(view, params_);
  const double fresh = novelty(passed, weakest ? std::optional{weakest->support} : std::nullopt);
  const double still_right = probability(right_log_odds_) * (1.0 - fresh * params_.lost_in_a_view);
  right_log_odds_ = log_odds(std::clamp(still_right, params_.least_wrong, 1.0 - params_.least_wrong));
  if (weakest) right_log_odds_ += fresh * weakest->evidence;
  judge_map(view, fresh);
  proof_ = proven ? 1.0 : proof_ * std::exp(-fresh / params_.proof_memory_views);
  trust_ = probability(right_log_odds_) * shares.believed;
  belief_ = judged(std::clamp(trust_, 1.0 - limit(), limit()));
}

void PoseJudge::judge_map(const ViewTally& view, double fresh) {
  const std::uint32_t expected = view.stable.expected + view.elsewhere.expected;
  if (expected == 0) return;
  const std::uint32_t fit = view.stable.fit + view.elsewhere.fit;
  const double misfit = 1.0 - static_cast<double>(fit) / static_cast<double>(expected);
  const double share = any_view_ ? 1.0 - std::exp(-fresh / kMapMemoryViews) : 1.0;
  misfit_share_ += share * (misfit - misfit_share_);
  any_view_ = true;
}

double PoseJudge::limit() const { return 1.0 - (1.0 - proof_) * (1.0 - params_.unproven_limit); }

/// The belief of this view, were the pose right with this probability by all but the other hypotheses.
Belief PoseJudge::judged(double right_by_beams) const {
  Belief belief = belief_;
  belief.pose_right = std::min(right_by_beams, 1.0 - shares_.best_other);
  const double wrong_if_right = probability(kMapSteepness * (misfit_share_ - params_.changed_above));
  belief.map_wrong = belief.pose_right * wrong_if_right + 0.5 * (1.0 - belief.pose_right);
  belief.verdict = PoseVerdict::kUndecided;
  if (shares_.searching) return belief;
  if (is_surely_right(belief.pose_right)) belief.verdict = PoseVerdict::kRight;
  const bool is_beaten = shares_.beaten;  // not by an alias that is only monitored
  if (right_by_beams <= kSurelyWrong && is_beaten) belief.verdict = PoseVerdict::kWrong;
  return belief;
}

}  // namespace deltamap::localization::belief
