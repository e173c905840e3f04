// SPDX-License-Identifier: Apache-2.0
#include "navigation/wheel_path.hpp"

#include <algorithm>

namespace deltamap::navigation {
namespace {

constexpr double kPathKeptS = 2.0;   // a scan of 0.5° at 9600 baud is 0.8 s old when it has come
constexpr double kAheadMostS = 0.5;  // past the newest packet the link is gone

}  // namespace

void WheelPath::observe(const Odometry& odometry) {
  const bool follows = !path_.empty() && path_.back().epoch == odometry.epoch && path_.back().time < odometry.time;
  if (!follows) path_.clear();
  path_.push_back(odometry);
  while (seconds(odometry.time - path_.front().time) > kPathKeptS) path_.pop_front();
}

std::optional<Pose2> WheelPath::odom_from_robot(Timestamp time) const {
  if (path_.empty() || time < path_.front().time) return std::nullopt;
  const auto after =
      std::find_if(path_.begin(), path_.end(), [&](const Odometry& odometry) { return odometry.time >= time; });
  if (after == path_.begin()) return after->odom_from_robot;
  const Odometry& before = *std::prev(after);
  const double ahead_s = seconds(time - before.time);
  if (after == path_.end()) {
    if (ahead_s > kAheadMostS) return std::nullopt;
    const double turn_rad = before.turn_rate_rad_per_s * ahead_s;
    const double along_m = before.speed_m_per_s * ahead_s;
    return before.odom_from_robot *
           Pose2{along_m * std::cos(0.5 * turn_rad), along_m * std::sin(0.5 * turn_rad), turn_rad};
  }
  return interpolated(before.odom_from_robot, after->odom_from_robot, ahead_s / seconds(after->time - before.time));
}

}  // namespace deltamap::navigation
