// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/continuity.hpp"

namespace deltamap::localization::belief {
namespace {

constexpr double kKidnappedWithinS = 5.0;  // after a break: so long a worse fit says that the robot was carried,
constexpr double kMostUnlikeS = 120.0;     // and then so long as much must fit as before

}  // namespace

bool Continuity::observe(const FollowedScan& scan, const Belief& believed, bool is_tracking) {
  const Timestamp time = scan.scan.time;
  inlier_drop_.observe(believed, time);
  const bool breaks_off = scan_break_.observe(scan);
  const std::optional<double> compared_over_s = scan_break_.compared_over_s();
  followed_s_ = is_tracking && compared_over_s && !breaks_off ? followed_s_ + *compared_over_s : 0.0;
  if (breaks_off && is_tracking) {
    broke_off_at_ = time;
    if (!suspected_since_) inlier_drop_.remember();
    if (!was_kidnapped_) suspected_since_ = time;
  }
  if (suspected_since_) {
    const double since_s = seconds(time - *suspected_since_);
    if (since_s < 0.0 || since_s > (was_kidnapped_ ? kMostUnlikeS : kKidnappedWithinS)) forget_suspicion();
  }
  const bool is_news = fits_worse() && !was_kidnapped_;
  was_kidnapped_ = was_kidnapped_ || is_news;
  if (fits_worse()) {
    is_unbroken_ = false;
  } else if (believed.verdict == PoseVerdict::kRight) {
    if (was_kidnapped_) forget_suspicion();
    is_unbroken_ = true;
  }
  return is_news;
}

bool Continuity::may_have_been_kidnapped() const { return !is_unbroken_ || followed_s_ < kMostUnlikeS; }

void Continuity::forget_suspicion() {
  suspected_since_.reset();
  was_kidnapped_ = false;
  inlier_drop_.forget();
}

}  // namespace deltamap::localization::belief
