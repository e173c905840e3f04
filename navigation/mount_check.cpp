// SPDX-License-Identifier: Apache-2.0
#include "navigation/mount_check.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.hpp"
#include "navigation/shown_motion.hpp"

namespace deltamap::navigation {
namespace {

// A way is long enough to show a direction, and short enough to see the same things at its end.
constexpr double kLeastWayM = 0.3;
constexpr double kLeastWayRad = 0.3;
constexpr double kMostWayM = 1.0;
constexpr double kMostWayRad = 0.8;
constexpr double kMostWayS = 6.0;

constexpr int kFewestEnds = 15;         // that would look different, or a way shows nothing
constexpr double kShowsWay = 0.6;       // share of these that show it,
constexpr double kClearlyBetter = 0.3;  // and so much more than by the other mount
constexpr double kSure = 1.5;           // sum of what ways show more by one mount than by the other: two clear ones,
constexpr double kMost = 6.0;           // and no more is remembered

Scan mounted(Scan scan, OtherMount mount) {
  switch (mount) {
    case OtherMount::kUpsideDown:
      std::reverse(scan.beams.begin(), scan.beams.end());
      scan.first_bearing_rad =
          -(scan.first_bearing_rad + scan.bearing_step_rad * (static_cast<double>(scan.beams.size()) - 1.0));
      break;
    case OtherMount::kTurnedLeft:
      scan.robot_from_laser.theta += radians(90.0);
      break;
    case OtherMount::kTurnedRound:
      scan.robot_from_laser.theta += radians(180.0);
      break;
    case OtherMount::kTurnedRight:
      scan.robot_from_laser.theta -= radians(90.0);
      break;
  }
  return scan;
}

/// Share of what should look different that does so as the wheels tell; nothing where nothing should.
std::optional<double> share_as_told(const Scan& before, const Scan& after, const Pose2& motion) {
  const ShownMotion shown = shown_motion(before, after, motion);
  return shown.asked >= kFewestEnds ? std::optional{shown.as_told} : std::nullopt;
}

}  // namespace

void MountCheck::observe(const Scan& scan, const Pose2& odom_from_robot, std::uint32_t epoch, bool in_doubt) {
  if (reference_) {
    const Pose2 motion = motion_between(reference_->odom_from_robot, odom_from_robot);
    const double way_m = motion.position().norm();
    const double turn_rad = std::abs(motion.theta);
    const double passed_s = seconds(scan.time - reference_->scan.time);
    const bool is_same_run = epoch == reference_->epoch && passed_s >= 0.0 && passed_s <= kMostWayS;
    const bool is_short = way_m < kLeastWayM && turn_rad < kLeastWayRad;
    if (is_same_run && is_short) return;
    const bool sees_the_same = way_m <= kMostWayM && turn_rad <= kMostWayRad;
    if (in_doubt && is_same_run && sees_the_same) compare(scan, motion);
  }
  reference_ = Reference{scan, odom_from_robot, epoch};
}

void MountCheck::compare(const Scan& scan, const Pose2& robot_before_from_after) {
  const std::optional<double> by_settings = share_as_told(reference_->scan, scan, robot_before_from_after);
  if (!by_settings) return;
  for (std::size_t i = 0; i < evidence_.size(); ++i) {
    const bool is_refuted = evidence_[i] <= -kMost;
    if (is_refuted && *by_settings >= kShowsWay) continue;
    const auto mount = static_cast<OtherMount>(i);
    const auto other = share_as_told(mounted(reference_->scan, mount), mounted(scan, mount), robot_before_from_after);
    if (!other || std::abs(*other - *by_settings) < kClearlyBetter) continue;
    if (std::max(*other, *by_settings) < kShowsWay) continue;
    evidence_[i] = std::clamp(evidence_[i] + *other - *by_settings, -kMost, kMost);
  }
}

std::optional<OtherMount> MountCheck::shown() const {
  const auto* const most = std::max_element(evidence_.begin(), evidence_.end());
  return *most >= kSure ? std::optional{static_cast<OtherMount>(most - evidence_.begin())} : std::nullopt;
}

}  // namespace deltamap::navigation
