// SPDX-License-Identifier: Apache-2.0
#include "navigation/lost_ends.hpp"

#include <algorithm>
#include <cmath>

#include "navigation/fan.hpp"

namespace deltamap::navigation {
namespace {

constexpr double kKeptS = 1.5;  // until a laser that sees nothing has stopped the robot, and it stands
constexpr double kNearM = 1.0;  // from the robot's middle: it would be there before a laser can be called blind
constexpr double kNextScanS = 0.5;
constexpr std::size_t kFewestSeen = 30;  // ends, to tell whether the next scan follows
constexpr double kSameM = 0.3;           // a slanted surface, seen from a little further on
constexpr double kSamePerM = 0.05;

Point2 end_in_robot(const Scan& scan, std::size_t beam) {
  const double range_m = static_cast<double>(scan.beams[beam].range_m);
  const double bearing = scan.bearing_rad(beam);
  return scan.robot_from_laser * Point2{range_m * std::cos(bearing), range_m * std::sin(bearing)};
}

/// Nothing came of it, not even that nothing lies within reach.
bool tells_nothing(const Beam& beam) { return beam.kind != BeamKind::kRange && beam.kind != BeamKind::kBeyondMaximum; }

/// Does the scan show something there, or near it? Nothing where it does not tell.
std::optional<bool> shows(const Scan& scan, const Point2& point_in_laser) {
  const auto beam = beam_towards(scan, point_in_laser);
  if (!beam || scan.beams[*beam].kind != BeamKind::kRange) return std::nullopt;
  const double expected_m = point_in_laser.norm();
  return std::abs(static_cast<double>(scan.beams[*beam].range_m) - expected_m) <= kSameM + kSamePerM * expected_m;
}

}  // namespace

void LostEnds::observe(const Scan& scan, const std::optional<Pose2>& odom_from_robot) {
  lost_in_robot_.clear();
  if (!odom_from_robot) return ends_.clear();
  const Pose2 robot_from_odom = inverse(*odom_from_robot);
  const Pose2 laser_from_odom = inverse(scan.robot_from_laser) * robot_from_odom;
  std::size_t told = 0;
  std::size_t seen_again = 0;
  for (const End& end : ends_) {
    const double age_s = seconds(scan.time - end.seen);
    const bool is_of_late = !end.kept_until && age_s > 0.0 && age_s < kNextScanS;
    const auto is_shown = is_of_late ? shows(scan, laser_from_odom * end.in_odom) : std::nullopt;
    told += is_shown ? 1 : 0;
    seen_again += is_shown && *is_shown ? 1 : 0;
  }
  const bool has_broken_off = told >= kFewestSeen && 2 * seen_again < told;
  std::vector<End> still;
  for (End end : ends_) {
    const double age_s = seconds(scan.time - end.seen);
    if (has_broken_off && !end.kept_until) end.kept_until = scan.time + duration_from_seconds(kKeptS);
    const auto beam = beam_towards(scan, laser_from_odom * end.in_odom);
    const bool is_answered = !beam || scan.beams[*beam].kind == BeamKind::kRange;
    const Point2 in_robot = robot_from_odom * end.in_odom;
    const bool is_held = beam && tells_nothing(scan.beams[*beam]) && in_robot.norm() < kNearM;
    const bool is_over = end.kept_until ? *end.kept_until < scan.time : is_answered || age_s > kKeptS;
    if ((is_over && !is_held) || age_s < 0.0) continue;
    still.push_back(end);
    lost_in_robot_.push_back(in_robot);
  }
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    if (scan.beams[i].kind == BeamKind::kRange)
      still.push_back({*odom_from_robot * end_in_robot(scan, i), scan.time, {}});
  }
  ends_ = std::move(still);
}

}  // namespace deltamap::navigation
