// SPDX-License-Identifier: Apache-2.0
#include "drivers/carmen/carmen_resets.hpp"

#include <algorithm>
#include <cmath>

#include "core/counted.hpp"
#include "core/geometry/angle.hpp"

namespace deltamap::drivers::carmen {
namespace {

constexpr double kShortest_s = 0.05;           // between two poses: stamps are not better than that
constexpr double kFasterThanNeighbours = 3.0;  // the speed of a jump: so much over that of the steps beside it
constexpr double kLongerThanNeighbours = 2.0;  // the way of a jump beside those of the steps beside it
constexpr double kJumpSpeed_m_per_s = 1.0;     // and by so much more: a robot does not brake from it within one step
constexpr double kJumpTurn_rad_per_s = 3.0;
constexpr double kLeastJump_m = 0.25;  // smaller jumps are what wheels slip
constexpr double kLeastTurn_rad = 0.35;
constexpr double kLeastReturn_m = 0.05;  // a jump to 0, 0, 0: where odometry begins
constexpr double kLeastReturn_rad = 0.05;

struct Step {
  double distance_m = 0.0;
  double turn_rad = 0.0;
  double duration_s = kShortest_s;
  [[nodiscard]] double speed_m_per_s() const { return distance_m / duration_s; }
  [[nodiscard]] double turn_rate_rad_per_s() const { return turn_rad / duration_s; }
};

Step step_between(const LoggedPose& from, const LoggedPose& to) {
  return {distance_between(from.odom_from_robot, to.odom_from_robot),
          std::abs(turn_between(from.odom_from_robot.theta, to.odom_from_robot.theta)),
          std::max(kShortest_s, seconds(to.time - from.time))};
}

bool is_beginning(const Pose2& pose) { return pose == Pose2{}; }

/// One measure of a step beside those of the steps before and after it.
struct Beside {
  double step = 0.0;
  double of_neighbours = 0.0;
  [[nodiscard]] bool is_over(double factor, double more) const { return step > factor * of_neighbours + more; }
};

/// Both, how far and how fast: stamps of single lines may be wrong.
bool is_jump(const Beside& way, double least_way, const Beside& speed, double least_more_speed) {
  return way.step > least_way && way.is_over(kLongerThanNeighbours, 0.0) &&
         speed.is_over(kFasterThanNeighbours, least_more_speed);
}

bool is_reset(const Step& before, const Step& step, const Step& after, bool leads_to_beginning) {
  const auto beside = [&](auto&& measure) { return Beside{measure(step), std::max(measure(before), measure(after))}; };
  const double more = leads_to_beginning ? 0.0 : 1.0;
  return is_jump(beside([](const Step& one) { return one.distance_m; }),
                 leads_to_beginning ? kLeastReturn_m : kLeastJump_m,
                 beside([](const Step& one) { return one.speed_m_per_s(); }), more * kJumpSpeed_m_per_s) ||
         is_jump(beside([](const Step& one) { return one.turn_rad; }),
                 leads_to_beginning ? kLeastReturn_rad : kLeastTurn_rad,
                 beside([](const Step& one) { return one.turn_rate_rad_per_s(); }), more * kJumpTurn_rad_per_s);
}

std::string times_from(std::span<const OdometryReset> resets) {
  return counted(resets.size(), "time") + " (the first in line " + std::to_string(resets.front().line) + ")";
}

}  // namespace

std::vector<OdometryReset> resets_in(std::span<const LoggedPose> poses) {
  std::vector<OdometryReset> resets;
  if (poses.size() < 3) return resets;  // a single step has none beside it
  Pose2 odom_from_log;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Step step = step_between(poses[i - 1], poses[i]);
    const Step before = i > 1 ? step_between(poses[i - 2], poses[i - 1]) : Step{};
    const Step after = i + 1 < poses.size() ? step_between(poses[i], poses[i + 1]) : Step{};
    const bool leads_to_beginning =
        is_beginning(poses[i].odom_from_robot) && !is_beginning(poses[i - 1].odom_from_robot);
    if (!is_reset(before, step, after, leads_to_beginning)) continue;
    odom_from_log = odom_from_log * poses[i - 1].odom_from_robot * inverse(poses[i].odom_from_robot);
    resets.push_back({poses[i].line, odom_from_log});
  }
  return resets;
}

Pose2 without_resets(std::span<const OdometryReset> resets, std::size_t line, const Pose2& pose) {
  const auto next =
      std::find_if(resets.rbegin(), resets.rend(), [&](const OdometryReset& one) { return one.line <= line; });
  return next == resets.rend() ? pose : next->odom_from_log * pose;
}

std::string resets_line(std::span<const OdometryReset> resets) {
  if (resets.empty()) return "";
  return "the odometry jumps " + times_from(resets) + ", as at a reset: no drive, its poses go on from where they were";
}

std::string laser_jumps_line(std::span<const OdometryReset> jumps) {
  if (jumps.empty()) return "";
  return "the laser's pose jumps " + times_from(jumps) +
         ", farther than a robot drives between two scans: the map is drawn at the poses as they are; are they of one "
         "frame, and corrected?";
}

}  // namespace deltamap::drivers::carmen
