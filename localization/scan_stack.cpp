// SPDX-License-Identifier: Apache-2.0
#include "localization/scan_stack.hpp"

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"
#include "localization/place_bank.hpp"

namespace deltamap::localization {

void ScanStack::add(const BeamEnds& ends, const Pose2& joined_from_robot) {
  constexpr double kApartM = 0.5;
  const double apart_rad = radians(30.0);
  if (ends.size() == 0) return;
  if (count_ > 0) {
    const Pose2 since = motion_between(kept_[newest_].joined_from_robot, joined_from_robot);
    if (since.position().norm() < kApartM && std::abs(since.theta) < apart_rad) return;
  }
  newest_ = (newest_ + 1) % kScans;
  count_ = std::min(count_ + 1, kScans);
  kept_[newest_].ends = ends;
  kept_[newest_].joined_from_robot = joined_from_robot;
}

double ScanStack::log_likelihood(const LikelihoodField& field, const Pose2& map_from_robot,
                                 const Pose2& joined_from_robot) const {
  double sum = 0.0;
  for (std::size_t back = 0; back < count_; ++back) {
    const Kept& kept = kept_[(newest_ + kScans - back) % kScans];
    const Pose2 now_from_then = motion_between(joined_from_robot, kept.joined_from_robot);
    sum += mean_log_likelihood(field, kept.ends, {}, map_from_robot * now_from_then);
  }
  return sum;
}

}  // namespace deltamap::localization
