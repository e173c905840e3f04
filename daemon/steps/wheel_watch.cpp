// SPDX-License-Identifier: Apache-2.0
#include "daemon/steps/wheel_watch.hpp"

#include <string>

namespace deltamap::daemon {
namespace {

// Recorded drives contradict their wheels in 1 to 2 % of the scans, those with turned or mirrored headings in 30 to 50
// %.
constexpr double kContradict = 0.25;
constexpr std::uint32_t kFewestScans = 100;
constexpr double kWindow_s = 120.0;
constexpr double kShortest_s = 60.0;  // nobody carries a robot for so long

// Of a pose that has never changed each contradiction counts: a robot that stands has none.
constexpr double kContradictStanding = 0.1;
constexpr int kFewestStanding = 10;  // seconds with a contradiction

constexpr std::uint32_t kOfLate = 10;  // scans

}  // namespace

void WheelWatch::observe(const Odometry& odometry) {
  if (!first_pose_) first_pose_ = odometry.odom_from_robot;
  has_moved_ = has_moved_ || !(odometry.odom_from_robot == *first_pose_);
}

LogLine WheelWatch::observe(const TrackedScan& tracked, std::uint64_t contradicted) {
  if (!first_pose_) return {};
  const bool spins = tracked.stood_m > 0.0;  // known, and no fault of the settings
  count(tracked.scan.time, contradicted > before_ && !spins);
  before_ = contradicted;
  return judged();
}

void WheelWatch::count(Timestamp time, bool contradicts) {
  if (!seconds_.empty() && time < seconds_.back().began) seconds_.clear();  // the clock was set back
  if (seconds_.empty() || seconds(time - seconds_.back().began) >= 1.0) seconds_.push_back({.began = time});
  ++seconds_.back().scans;
  seconds_.back().contradicted += contradicts ? 1 : 0;
  while (seconds(time - seconds_.front().began) > kWindow_s) seconds_.pop_front();
}

bool WheelWatch::contradicted_of_late() const {
  std::uint32_t seen = 0;
  std::uint32_t count = 0;
  for (auto one = seconds_.rbegin(); one != seconds_.rend() && seen < kOfLate; ++one) {
    seen += one->scans;
    count += one->contradicted;
  }
  return count > 0 && static_cast<double>(count) >= kContradictStanding * static_cast<double>(seen);
}

LogLine WheelWatch::judged() {
  std::uint32_t seen = 0;
  std::uint32_t count = 0;
  int with_any = 0;
  for (const Second& one : seconds_) {
    seen += one.scans;
    count += one.contradicted;
    with_any += one.contradicted > 0 ? 1 : 0;
  }
  const double share = static_cast<double>(count) / static_cast<double>(seen);
  const double limit = has_moved_ ? kContradict : kContradictStanding;
  if (contradict_) {
    contradict_ = !has_moved_ || share >= limit / 2.0;
    return {contradict_ ? "" : "wheels and scans agree again"};
  }
  const double watched_s = seconds(seconds_.back().began - seconds_.front().began);
  const bool is_enough = has_moved_ ? seen >= kFewestScans && watched_s >= kShortest_s : with_any >= kFewestStanding;
  if (!is_enough || share < limit) return {};
  contradict_ = true;
  const std::string scans = "in " + std::to_string(count) + " of the last " + std::to_string(seen) + " scans";
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
