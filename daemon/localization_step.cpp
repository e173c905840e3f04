// SPDX-License-Identifier: Apache-2.0
#include "daemon/localization_step.hpp"

#include <algorithm>

namespace deltamap::daemon {
namespace {

constexpr std::size_t kRecentOdometry = 16;
constexpr double kLongestExtrapolation_s = 0.15;  // CONTRACT, poses and time

std::optional<localization::InitialPose> initial_pose(const Settings& settings) {
  if (!settings.initial_pose) return std::nullopt;
  return localization::InitialPose{*settings.initial_pose};
}

}  // namespace

LocalizationStep::LocalizationStep(const Settings& settings, const StartMap& start)
    : localizer_{settings.localizer, start.map, initial_pose(settings), settings.seed},
      last_map_from_robot_{settings.initial_pose.value_or(Pose2{})} {
  if (start.revision > 0)
    apply({.number = start.revision, .time = {}, .map = start.map, .changes = {}, .field_patch = {}});
}

void LocalizationStep::observe(const Odometry& odometry) {
  localizer_.observe(odometry);
  if (recent_odometry_.size() == kRecentOdometry) recent_odometry_.pop_front();
  recent_odometry_.push_back(odometry);
}

TrackedScan LocalizationStep::observe(Scan scan) {
  TrackedScan tracked = localizer_.observe(std::move(scan));
  last_map_from_robot_ = tracked.estimate.map_from_robot;
  last_odom_from_robot_ = tracked.odom_from_robot;
  last_epoch_ = tracked.odometry_epoch;
  count_time(tracked.scan.time);
  last_state_ = tracked.estimate.state;
  return tracked;
}

TrajectoryPoint LocalizationStep::pass_over(const Scan& scan) {
  count_time(scan.time);
  const auto odometry = odometry_at(scan.time);
  if (!odometry || odometry->epoch != last_epoch_) return {scan.time, last_map_from_robot_};
  return {scan.time, last_map_from_robot_ * motion_between(last_odom_from_robot_, odometry->odom_from_robot)};
}

void LocalizationStep::apply(const MapRevision& revision) { localizer_.apply(revision); }

double LocalizationStep::covered_s() const { return first_scan_ ? seconds(*last_scan_ - *first_scan_) : 0.0; }

std::optional<Odometry> LocalizationStep::odometry_at(Timestamp time) const {
  if (recent_odometry_.empty()) return std::nullopt;
  const auto after = std::find_if(recent_odometry_.begin(), recent_odometry_.end(),
                                  [&](const Odometry& odometry) { return odometry.time >= time; });
  if (after == recent_odometry_.begin()) return recent_odometry_.front();
  const bool is_past_newest = after == recent_odometry_.end();
  if (is_past_newest && recent_odometry_.size() < 2) return recent_odometry_.back();
  const Odometry& to = is_past_newest ? recent_odometry_.back() : *after;
  const Odometry& from = is_past_newest ? *(recent_odometry_.end() - 2) : *(after - 1);
  const double step_s = seconds(to.time - from.time);
  if (from.epoch != to.epoch || step_s <= 0.0) return to;
  const double reached_s = std::min(seconds(time - from.time), step_s + kLongestExtrapolation_s);
  Odometry at = to;
  at.odom_from_robot = interpolated(from.odom_from_robot, to.odom_from_robot, reached_s / step_s);
  return at;
}

void LocalizationStep::count_time(Timestamp time) {
  if (!first_scan_) first_scan_ = time;
  if (last_scan_) {
    const double passed_s = std::max(0.0, seconds(time - *last_scan_));
    if (last_state_ == LocalizerState::kLost) time_lost_s_ += passed_s;
    if (last_state_ == LocalizerState::kGlobal) time_global_s_ += passed_s;
  }
  last_scan_ = time;
}

}  // namespace deltamap::daemon
