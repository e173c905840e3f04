// SPDX-License-Identifier: Apache-2.0
#include "localization/pose_verdict.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace deltamap::localization {
namespace {

constexpr double kOtherView = 0.25;    // a hold that has changed so much is a new view, whatever odometry says
constexpr double kBeamsOfDoubt = 3.0;  // few beams leave a hold near one half
constexpr double kMapMemoryViews = 3.0;
constexpr double kMapSteepness = 25.0;  // log-odds a unit of the share of beams off the map

double probability(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }
double log_odds(double probability) { return std::log(probability / (1.0 - probability)); }

/// Share of the beams that hold the pose in a direction; nothing where too few tell of it.
std::optional<double> hold_along(const Support& support, const PoseVerdictParams& params) {
  const double telling = support.fit + params.short_weight * support.short_of + support.beyond;
  if (support.expected() < params.least_beams || telling <= 0.0) return std::nullopt;
  return (support.fit + 0.5 * kBeamsOfDoubt) / (telling + kBeamsOfDoubt);
}

/// How well the pose is held where it is held worst.
std::optional<double> weakest_hold(const std::array<Support, 2>& along, const PoseVerdictParams& params) {
  const std::optional<double> first = hold_along(along[0], params);
  const std::optional<double> second = hold_along(along[1], params);
  if (!first || !second) return first ? first : second;
  return std::min(*first, *second);
}

/// ln p(hold | right) - ln p(hold | wrong) of one new view, halved because views of one drive are alike. From drives
/// in the paper's hall at right poses (unchanged, 10 %, 50 % changed) and wrong ones; docs/decisions/two_answers.md.
double evidence_of(double hold) {
  constexpr std::array<double, 11> kByTenths{-2.6, -2.6, -2.2, -1.4, -0.3, 0.25, 0.5, 0.75, 1.0, 1.2, 1.2};
  const double at = 10.0 * std::clamp(hold, 0.0, 1.0);
  const std::size_t below = std::min<std::size_t>(9, static_cast<std::size_t>(at));
  const double share = at - static_cast<double>(below);
  return kByTenths[below] + share * (kByTenths[below + 1] - kByTenths[below]);
}

std::array<Support, 2> sum_of(const std::array<Support, 2>& a, const std::array<Support, 2>& b) {
  std::array<Support, 2> sum = a;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i].fit += b[i].fit;
    sum[i].short_of += b[i].short_of;
    sum[i].beyond += b[i].beyond;
  }
  return sum;
}

}  // namespace

void PoseJudge::start(double pose_right) {
  right_log_odds_ = log_odds(std::clamp(pose_right, params_.least_wrong, 1.0 - params_.least_wrong));
  any_view_ = false;
  last_hold_.reset();
  belief_ = {};
  trust_ = belief_.pose_right = pose_right;
}

double PoseJudge::novelty(const Passed& passed, std::optional<double> hold) {
  const bool other = hold && last_hold_ && std::abs(*hold - *last_hold_) > kOtherView;
  last_hold_ = hold;
  if (other || !any_view_) return 1.0;
  return std::min(
      1.0, passed.driven_m / params_.view_m + passed.turned_rad / params_.view_rad + passed.time_s / params_.view_s);
}

void PoseJudge::observe(const ViewTally& view, const Passed& passed, const Shares& shares) {
  belief_.stable = view.stable;
  belief_.elsewhere = view.elsewhere;
  belief_.rival_share = shares.best_rival;
  belief_.map_from_rival = shares.map_from_rival;

  std::optional<double> hold = weakest_hold(view.stable_along, params_);
  const bool proven = hold.has_value();
  if (!proven) hold = weakest_hold(sum_of(view.stable_along, view.elsewhere_along), params_);
  const double fresh = novelty(passed, hold);
  const double still_right = probability(right_log_odds_) * (1.0 - fresh * params_.lost_in_a_view);
  right_log_odds_ = log_odds(std::clamp(still_right, params_.least_wrong, 1.0 - params_.least_wrong));
  if (hold) right_log_odds_ += fresh * evidence_of(*hold);
  judge_map(view, fresh);
  decide(proven, shares);
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

void PoseJudge::decide(bool proven, const Shares& shares) {
  trust_ = probability(right_log_odds_) * shares.believed;
  belief_.pose_right = proven ? trust_ : std::clamp(trust_, 1.0 - params_.unproven_limit, params_.unproven_limit);
  const double wrong_if_right = probability(kMapSteepness * (misfit_share_ - params_.changed_above));
  belief_.map_wrong = belief_.pose_right * wrong_if_right + 0.5 * (1.0 - belief_.pose_right);
  if (shares.searching) {
    belief_.verdict = PoseVerdict::kUndecided;
    return;
  }
  belief_.verdict = belief_.pose_right >= params_.right_above   ? PoseVerdict::kRight
                    : belief_.pose_right <= params_.wrong_below ? PoseVerdict::kWrong
                                                                : PoseVerdict::kUndecided;
}

}  // namespace deltamap::localization
