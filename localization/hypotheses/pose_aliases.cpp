// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/pose_aliases.hpp"

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"

namespace deltamap::localization::hypotheses {
namespace {

constexpr double kForgottenAfter_m = 1000.0;
constexpr double kSame_m = 0.5;
const double kSame_rad = radians(10.0);

}  // namespace

void PoseAliases::note(const Pose2& map_from_believed, const Pose2& map_from_hypothesis, double followed_m) {
  const Alias seen{.map_from_map = map_from_hypothesis * inverse(map_from_believed), .followed_m = followed_m};
  for (Alias& alias : aliases_) {
    const Pose2 expected = alias.map_from_map * map_from_believed;
    if (distance_between(expected, map_from_hypothesis) > kSame_m ||
        std::abs(turn_between(expected.theta, map_from_hypothesis.theta)) > kSame_rad) {
      continue;
    }
    alias = {.map_from_map = seen.map_from_map, .followed_m = std::max(alias.followed_m, followed_m)};
    return;
  }
  if (aliases_.size() < most_) {
    aliases_.push_back(seen);
    return;
  }
  const auto least = std::min_element(aliases_.begin(), aliases_.end(),
                                      [](const Alias& a, const Alias& b) { return a.followed_m < b.followed_m; });
  if (least != aliases_.end() && least->followed_m < followed_m) *least = seen;
}

void PoseAliases::age(double driven_m) {
  for (Alias& alias : aliases_) alias.driven_since_m += driven_m;
  std::erase_if(aliases_, [](const Alias& alias) { return alias.driven_since_m > kForgottenAfter_m; });
}

std::optional<Pose2> PoseAliases::next(const Pose2& map_from_believed) {
  if (aliases_.empty()) return std::nullopt;
  next_ = (next_ + 1) % aliases_.size();
  return aliases_[next_].map_from_map * map_from_believed;
}

}  // namespace deltamap::localization::hypotheses
