// SPDX-License-Identifier: Apache-2.0
#include "mapping/gate/inlier_drop.hpp"

#include <algorithm>

namespace deltamap::mapping::gate {
namespace {

double approached(double mean, double value, double by) { return mean + std::min(1.0, by) * (value - mean); }

}  // namespace

void InlierDropDetector::observe(const TrackedScan& tracked) {
  const Belief& belief = tracked.estimate.belief;
  const std::uint32_t expected = belief.stable.expected + belief.elsewhere.expected;
  if (expected < params_.least_expected) return;
  const std::uint32_t missed =
      belief.stable.short_of + belief.elsewhere.short_of + belief.stable.beyond + belief.elsewhere.beyond;
  const double now = static_cast<double>(missed) / expected;
  if (!last_) usual_ = present_ = now;
  const double since_last_s = last_ ? seconds(tracked.scan.time - *last_) : 0.0;
  const double passed_s = std::clamp(since_last_s, 0.0, params_.most_of_a_scan_s);
  last_ = tracked.scan.time;
  known_for_s_ += passed_s;
  usual_ = approached(usual_, now, passed_s / params_.usual_s);
  present_ = approached(present_, now, passed_s / params_.present_s);
}

bool InlierDropDetector::is_worse_than_remembered() const {
  return remembered_ && present_ - *remembered_ > params_.most_drop;
}

}  // namespace deltamap::mapping::gate
