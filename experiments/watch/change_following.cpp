// SPDX-License-Identifier: Apache-2.0
#include "experiments/watch/change_following.hpp"

#include <algorithm>
#include <limits>

#include "experiments/experiment.hpp"

namespace deltamap::experiments {
namespace {

namespace score = simulation::score;

constexpr double kFoundShare = 0.5;  // of a change's visible cells must be right
constexpr double kSeenLeast_s = 10.0;

bool is_of(const score::ScoredChange& change, ChangeFollowing::Which which) {
  if (which == ChangeFollowing::Which::kAll) return true;
  return change.appears == (which == ChangeFollowing::Which::kAppeared);
}

}  // namespace

void ChangeFollowing::judge(score::ChangeWatch& changes, const OccupancyGrid& map, const OccupancyGrid& surfaces,
                            double now_s, const ChangeFollowing* without) {
  score::ChangeScoreParams params;
  params.found_share = kFoundShare;
  params.seen_least_s = kSeenLeast_s;
  fates_.resize(changes.watched().size());
  for (std::size_t i = 0; i < fates_.size(); ++i) {
    Fate& fate = fates_[i];
    if (fate.is_settled || fate.followed_after_s >= 0.0) continue;
    score::Watched& watched = changes.watched()[i];
    if (watched.change.is_overtaken) {
      fate.is_settled = true;
      continue;
    }
    changes.judge(watched, map, surfaces, params);
    const score::ScoredChange& change = watched.change;
    if (change.visible_cells == 0 || change.seen_s <= 0.0) continue;
    const bool is_followed = change.is_followed(kFoundShare);
    if (fate.first_seen_s < 0.0) {
      fate.first_seen_s = now_s;
      fate.was_right = without == nullptr ? is_followed : without->fates_[i].was_right;
      fate.is_settled = fate.was_right;
    }
    if (is_followed && !fate.was_right) {
      fate.followed_after_s = change.seen_s;
      fate.followed_after_clock_s = now_s - fate.first_seen_s;
    }
  }
}

ChangeFollowing::Numbers ChangeFollowing::numbers(score::ChangeWatch& changes, Which which) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  std::vector<double> in_view_s;
  std::vector<double> clock_s;
  Numbers numbers;
  for (std::size_t i = 0; i < fates_.size(); ++i) {
    const score::Watched& watched = changes.watched()[i];
    if (fates_[i].was_right || fates_[i].first_seen_s < 0.0 || !is_of(watched.change, which)) continue;
    if (watched.witness.longest_seen_s() < kSeenLeast_s) continue;
    const bool is_found = fates_[i].followed_after_s >= 0.0;
    numbers.found += is_found ? 1 : 0;
    in_view_s.push_back(is_found ? fates_[i].followed_after_s : kNever);
    clock_s.push_back(is_found ? fates_[i].followed_after_clock_s : kNever);
  }
  numbers.seen = in_view_s.size();
  const auto share = [&](std::ptrdiff_t part) {
    return numbers.seen == 0 ? std::numeric_limits<double>::quiet_NaN()
                             : static_cast<double>(part) / static_cast<double>(numbers.seen);
  };
  numbers.recall = share(static_cast<std::ptrdiff_t>(numbers.found));
  numbers.median_s = quantile(in_view_s, 0.5);
  numbers.p90_s = quantile(in_view_s, 0.9);
  numbers.clock_median_s = quantile(clock_s, 0.5);
  numbers.within_10s = share(std::count_if(in_view_s.begin(), in_view_s.end(), [](double s) { return s <= 10.0; }));
  return numbers;
}

}  // namespace deltamap::experiments
