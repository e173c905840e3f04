// SPDX-License-Identifier: Apache-2.0
// Which scans are keyframes: those that show enough that is new since the last one.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/messages.hpp"
#include "mapping/scan_set/keyframe_pool.hpp"

namespace deltamap::mapping::scan_set {

/// Where and when a scan was taken.
struct ScanPlace {
  Pose2 odom_from_robot;
  std::uint32_t epoch = 0;
  Timestamp time;
};

[[nodiscard]] inline ScanPlace place_of(const TrackedScan& tracked) {
  return {tracked.odom_from_robot, tracked.odometry_epoch, tracked.scan.time};
}

/// Has the robot moved, turned or waited enough since the last keyframe, or its odometry begun anew?
[[nodiscard]] inline bool is_next_keyframe(const KeyframeParams& params, const ScanPlace& last, const ScanPlace& now) {
  if (last.epoch != now.epoch) return true;
  const Pose2 motion = motion_between(last.odom_from_robot, now.odom_from_robot);
  return motion.position().norm() >= params.moved_m || std::abs(motion.theta) >= params.turned_rad ||
         seconds(now.time - last.time) >= params.waited_s;
}

}  // namespace deltamap::mapping::scan_set
