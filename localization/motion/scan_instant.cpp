// SPDX-License-Identifier: Apache-2.0
#include "localization/motion/scan_instant.hpp"

#include <algorithm>

namespace deltamap::localization::motion {
namespace {

constexpr double kFarthestGuessS = 3.0;      // of silence: after longer ones particles near the old pose are no guess
constexpr double kJumpBetweenEpochsS = 0.3;  // how long odometry counts as silent when its epoch changes

/// More than the totals of an earlier instant.
MotionVariance more(const MotionVariance& before, const MotionVariance& now) {
  return {std::max(0.0, now.position_m2 - before.position_m2), std::max(0.0, now.heading_rad2 - before.heading_rad2)};
}

}  // namespace

MotionSince motion_since(const ScanInstant& last, const ScanInstant& now, double usual_s) {
  MotionSince since;
  since.passed_s = std::max(0.0, seconds(now.time - last.time));
  if (!now.odometry || !last.odometry) {
    since.unknown_s = since.passed_s;
    return since;
  }
  since.motion = motion_between(last.odometry->continuous_odom_from_robot, now.odometry->continuous_odom_from_robot);
  since.by_scans = now.odometry->led_since && *now.odometry->led_since <= last.time;
  since.slipped = more(last.odometry->slipped, now.odometry->slipped);
  since.unknown_s = std::min(now.odometry->uncovered_s, since.passed_s);
  if (now.odometry->epoch != last.odometry->epoch) {
    const double silent_s = since.passed_s > 2.0 * usual_s ? since.passed_s : 0.0;
    since.unknown_s += std::clamp(silent_s, kJumpBetweenEpochsS, kFarthestGuessS);
  }
  return since;
}

Pose2 counted_between(const ScanInstant& before, const ScanInstant& now) {
  if (!now.odometry || !before.odometry) return {};
  const OdometryAt& from = *before.odometry;
  const OdometryAt& to = *now.odometry;
  return from.epoch == to.epoch ? motion_between(from.odom_from_robot, to.odom_from_robot)
                                : motion_between(from.continuous_odom_from_robot, to.continuous_odom_from_robot);
}

MotionSince step_between(const ScanInstant& before, const ScanInstant& now) {
  MotionSince step;
  step.passed_s = std::max(0.0, seconds(now.time - before.time));
  step.unknown_s = step.passed_s;
  if (!now.odometry || !before.odometry) return step;
  step.motion = motion_between(before.odometry->continuous_odom_from_robot, now.odometry->continuous_odom_from_robot);
  step.by_scans = now.odometry->led_since && *now.odometry->led_since <= before.time;
  step.slipped = more(before.odometry->slipped, now.odometry->slipped);
  const bool jumped = now.odometry->epoch != before.odometry->epoch;
  if (!jumped) step.unknown_s = std::min(now.odometry->uncovered_s, step.passed_s);
  return step;
}

}  // namespace deltamap::localization::motion
