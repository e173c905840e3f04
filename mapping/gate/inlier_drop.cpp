// SPDX-License-Identifier: Apache-2.0
#include "mapping/gate/inlier_drop.hpp"

#include <algorithm>

namespace deltamap::mapping::gate {
namespace {

/// Share of the beams that usually do not fit, up to which the map is taken for right: in a hall that is half changed
/// every corner shows another view.
constexpr double kMostUsual = 0.15;

/// Of the time over which the last moment is averaged: so much a scan after a silence counts at most. More would
/// swallow what was before, and with it all that has changed meanwhile.
constexpr double kMostOfAMoment = 0.5;

double approached(double mean, double value, double passed_s, double over_s) {
  return mean + std::min(1.0, passed_s / over_s) * (value - mean);
}

}  // namespace

void InlierDropDetector::observe(const TrackedScan& tracked) {
  const Belief& belief = tracked.estimate.belief;
  const std::uint32_t expected = belief.stable.expected + belief.elsewhere.expected;
  if (expected < params_.least_expected) return;
  const Shares now{static_cast<double>(belief.stable.short_of + belief.elsewhere.short_of) / expected,
                   static_cast<double>(belief.stable.beyond + belief.elsewhere.beyond) / expected};
  if (!last_) usual_ = lately_ = present_ = now;
  const double since_last_s = last_ ? seconds(tracked.scan.time - *last_) : 0.0;
  const double passed_s = std::clamp(since_last_s, 0.0, kMostOfAMoment * params_.lately_s);
  last_ = tracked.scan.time;
  known_for_s_ += passed_s;
  for (double Shares::*share : {&Shares::short_of, &Shares::beyond}) {
    usual_.*share = approached(usual_.*share, now.*share, passed_s, params_.usual_s);
    lately_.*share = approached(lately_.*share, now.*share, passed_s, params_.lately_s);
    present_.*share = approached(present_.*share, now.*share, passed_s, params_.present_s);
  }
}

bool InlierDropDetector::is_sudden() const {
  if (usual_.short_of + usual_.beyond > kMostUsual) return false;
  return present_.short_of + present_.beyond - usual_.short_of - usual_.beyond > params_.most_drop;
}

bool InlierDropDetector::is_worse_than_remembered(double explained) const {
  if (!remembered_) return false;
  const double more = present_.short_of + present_.beyond - remembered_->short_of - remembered_->beyond;
  return more > params_.most_drop + explained;
}

bool InlierDropDetector::is_both_ways() const {
  if (usual_.short_of + usual_.beyond > kMostUsual) return false;
  const auto both_more_than = [&](const Shares& before) {
    return std::min(present_.short_of - before.short_of, present_.beyond - before.beyond);
  };
  return both_more_than(usual_) > params_.most_drop_both_ways && both_more_than(lately_) > params_.least_at_once;
}

}  // namespace deltamap::mapping::gate
