// SPDX-License-Identifier: Apache-2.0
#include "daemon/steps/wheel_watch.hpp"

#include <algorithm>
#include <string>

namespace deltamap::daemon {
namespace {

// Recorded drives contradict their wheels in 1 to 2 % of the scans, those with turned or mirrored headings in 30 to 50
// %.
constexpr double kContradict = 0.25;
constexpr std::size_t kFewestScans = 100;
constexpr double kShortest_s = 60.0;  // nobody carries a robot for so long

// Of a pose that has never changed each contradiction counts: a robot that stands has none.
constexpr double kContradictStanding = 0.1;
constexpr std::size_t kFewestStanding = 20;  // contradictions

}  // namespace

void WheelWatch::observe(const Odometry& odometry) {
  if (!first_pose_) first_pose_ = odometry.odom_from_robot;
  has_moved_ = has_moved_ || !(odometry.odom_from_robot == *first_pose_);
}

LogLine WheelWatch::observe(const TrackedScan& tracked, std::uint64_t contradicted) {
  if (!first_pose_) return {};
  if (!began_) began_ = tracked.scan.time;
  watched_s_ = seconds(tracked.scan.time - *began_);
  const bool spins = tracked.stood_m > 0.0;  // known, and no fault of the settings
  contradicted_[next_] = contradicted > before_ && !spins;
  before_ = contradicted;
  next_ = (next_ + 1) % kScans;
  seen_ = std::min(seen_ + 1, kScans);
  return judged(contradicted_.count());
}

LogLine WheelWatch::judged(std::size_t count) {
  const double share = static_cast<double>(count) / static_cast<double>(seen_);
  const double limit = has_moved_ ? kContradict : kContradictStanding;
  if (contradict_) {
    contradict_ = !has_moved_ || share >= limit / 2.0;
    return {contradict_ ? "" : "wheels and scans agree again"};
  }
  const bool is_enough = has_moved_ ? seen_ >= kFewestScans && watched_s_ >= kShortest_s : count >= kFewestStanding;
  if (!is_enough || share < limit) return {};
  contradict_ = true;
  const std::string scans = "in " + std::to_string(count) + " of the last " + std::to_string(seen_) + " scans";
  if (!has_moved_) {
    return {"the robot's pose has never changed, and " + scans +
                " it moves: check whether the controller, or the log, tells poses at all; the map is not written",
            true};
  }
  return {"wheels and scans contradict each other " + scans +
              ": check the headings and axes of the robot's poses, 'robot.model' and 'laser.mount'; the map is not "
              "written meanwhile",
          true};
}

}  // namespace deltamap::daemon
