// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/scan_stack.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.hpp"

namespace deltamap::localization::hypotheses {

void ScanStack::add(const motion::BeamEnds& ends, const Pose2& continuous_odom_from_robot) {
  const double apart_rad = radians(30.0);
  if (ends.size() == 0) return;
  double since_last_m = 0.0;
  if (count_ > 0) {
    const Pose2 since = motion_between(kept_[newest_].continuous_odom_from_robot, continuous_odom_from_robot);
    since_last_m = since.position().norm();
    if (since_last_m < kApartM && std::abs(since.theta) < apart_rad) return;
  }
  newest_ = (newest_ + 1) % kScans;
  count_ = std::min(count_ + 1, kScans);
  kept_[newest_].ends = ends;
  const std::span<const float> weights = decorrelation_.weights(ends, continuous_odom_from_robot);
  kept_[newest_].weights.assign(weights.begin(), weights.end());
  kept_[newest_].continuous_odom_from_robot = continuous_odom_from_robot;
  kept_[newest_].since_last_m = since_last_m;
}

void ScanStack::keep_last(double driven_m) {
  std::size_t kept = 0;
  for (double back_m = 0.0; kept < count_ && back_m <= driven_m; ++kept) back_m += newest_but(kept).since_last_m;
  count_ = kept;
}

ScanStack::Sums ScanStack::log_likelihoods(const sensor::LikelihoodField& field, const Pose2& map_from_robot,
                                           const Pose2& continuous_odom_from_robot) const {
  Sums sums{};
  double sum = 0.0;
  for (std::size_t back = 0; back < count_; ++back) {
    const Kept& kept = newest_but(back);
    const Pose2 now_from_then = motion_between(continuous_odom_from_robot, kept.continuous_odom_from_robot);
    sum += weighted_log_likelihood(field, kept.ends, kept.weights, map_from_robot * now_from_then);
    sums[back] = sum;
  }
  return sums;
}

Comparison ScanStack::compared_lately(const sensor::LikelihoodField& field, const Pose2& hypothesis, const Pose2& other,
                                      const Pose2& continuous_odom_from_robot, double of_a_beam) const {
  constexpr std::size_t kLately = 6;
  Comparison sum;
  Comparison most;
  for (std::size_t back = 0; back < std::min(count_, kLately); ++back) {
    const Kept& kept = newest_but(back);
    const Pose2 now_from_then = motion_between(continuous_odom_from_robot, kept.continuous_odom_from_robot);
    const Comparison then =
        compared(field, kept.ends, kept.weights, hypothesis * now_from_then, other * now_from_then, of_a_beam);
    sum.gained += then.gained;
    sum.lost += then.lost;
    if (sum.ahead() > most.ahead()) most = sum;
  }
  return most;
}

}  // namespace deltamap::localization::hypotheses
