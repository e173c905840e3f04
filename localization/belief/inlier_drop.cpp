// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/inlier_drop.hpp"

#include <algorithm>

#include "localization/belief/usual_view.hpp"

namespace deltamap::localization::belief {
namespace {

constexpr double kPresentS = 0.35;     // over which the present share is averaged
constexpr double kMostOfAScanS = 0.5;  // that a scan after a silence counts: more would swallow what was before
constexpr double kMostDrop = 0.2;      // of the share of beams

double approached(double mean, double value, double by) { return mean + std::min(1.0, by) * (value - mean); }

}  // namespace

void InlierDropDetector::observe(const Belief& belief, Timestamp time) {
  const std::uint32_t expected = belief.stable.expected + belief.elsewhere.expected;
  if (expected < kLeastCompared) return;
  const std::uint32_t missed =
      belief.stable.short_of + belief.elsewhere.short_of + belief.stable.beyond + belief.elsewhere.beyond;
  const double now = static_cast<double>(missed) / expected;
  if (!last_) usual_ = present_ = now;
  const double since_last_s = last_ ? seconds(time - *last_) : 0.0;
  const double passed_s = std::clamp(since_last_s, 0.0, kMostOfAScanS);
  last_ = time;
  known_for_s_ += passed_s;
  usual_ = approached(usual_, now, passed_s / kUsualS);
  present_ = approached(present_, now, passed_s / kPresentS);
}

void InlierDropDetector::remember() {
  if (known_for_s_ >= kUsualS) remembered_ = usual_;
}

bool InlierDropDetector::is_worse_than_remembered() const { return remembered_ && present_ - *remembered_ > kMostDrop; }

}  // namespace deltamap::localization::belief
