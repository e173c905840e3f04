// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/scan_break.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "localization/belief/usual_view.hpp"

namespace deltamap::localization::belief {
namespace {

constexpr double kBeside = 2.0;     // beams on each side of the one that should end there: edges, deskewing
constexpr std::size_t kStride = 2;  // every other beam will do

bool has_range(const FollowedScan& now, std::size_t i) { return now.scan.beams[i].kind == BeamKind::kRange; }

double bearing_of(const Eigen::Vector2f& way) {
  return std::atan2(static_cast<double>(way.y()), static_cast<double>(way.x()));
}

}  // namespace

std::optional<ScanBreak::Shares> ScanBreak::compared(const FollowedScan& now, const Pose2& now_from_last) const {
  const std::span<const RayInRobot> rays = now.rays;
  std::size_t first = 0;
  while (first < rays.size() && !has_range(now, first)) ++first;
  if (first == rays.size()) return std::nullopt;
  const Eigen::Vector2f laser = rays[first].origin;
  const double first_bearing_rad = bearing_of(rays[first].end - laser);
  const auto beams = static_cast<std::ptrdiff_t>(rays.size());
  const auto c = static_cast<float>(std::cos(now_from_last.theta));
  const auto s = static_cast<float>(std::sin(now_from_last.theta));
  const Eigen::Vector2f moved{static_cast<float>(now_from_last.x), static_cast<float>(now_from_last.y)};
  const auto least_m = static_cast<float>(params_.least_m);
  const double unsure_rad = params_.wheels_rad_per_m * now_from_last.position().norm() +
                            params_.wheels_rad_per_rad * std::abs(now_from_last.theta);
  const auto beside = static_cast<std::ptrdiff_t>(std::lround(kBeside + unsure_rad / now.scan.bearing_step_rad));

  std::uint32_t compared = 0;
  Shares shares;
  for (const Eigen::Vector2f& end : ends_) {
    const Eigen::Vector2f way = moved + Eigen::Vector2f{c * end.x() - s * end.y(), s * end.x() + c * end.y()} - laser;
    const double turn_rad = turn_between(first_bearing_rad, bearing_of(way));
    const auto beam = static_cast<std::ptrdiff_t>(first) +
                      static_cast<std::ptrdiff_t>(std::lround(turn_rad / now.scan.bearing_step_rad));
    if (beam < beside || beam + beside >= beams) continue;
    float shortest_m = std::numeric_limits<float>::infinity();
    float longest_m = 0.0F;
    for (std::ptrdiff_t i = beam - beside; i <= beam + beside; ++i) {
      const Beam& near = now.scan.beams[static_cast<std::size_t>(i)];
      if (near.kind != BeamKind::kRange) continue;
      shortest_m = std::min(shortest_m, near.range_m);
      longest_m = std::max(longest_m, near.range_m);
    }
    if (longest_m == 0.0F) continue;
    ++compared;
    const float expected_m = way.norm();
    shares.nearer += longest_m < expected_m - least_m ? 1.0 : 0.0;
    shares.farther += shortest_m > expected_m + least_m ? 1.0 : 0.0;
  }
  if (compared < kLeastCompared) return std::nullopt;
  return Shares{shares.nearer / compared, shares.farther / compared};
}

void ScanBreak::keep(const FollowedScan& now) {
  ends_.clear();
  for (std::size_t i = 0; i < now.rays.size(); i += kStride) {
    if (has_range(now, i)) ends_.push_back(now.rays[i].end);
  }
  odom_from_robot_ = now.odom_from_robot;
  map_from_robot_ = now.map_from_robot;
  epoch_ = now.odometry_epoch;
  last_ = now.scan.time;
}

/// By the wheels or by the estimate, whichever explains the scan better.
std::optional<ScanBreak::Shares> ScanBreak::least_compared(const FollowedScan& now) const {
  const auto by_wheels = compared(now, inverse(now.odom_from_robot) * odom_from_robot_);
  if (!by_wheels || by_wheels->both() == 0.0) return by_wheels;
  const auto by_estimate = compared(now, inverse(now.map_from_robot) * map_from_robot_);
  return by_estimate && by_estimate->both() < by_wheels->both() ? by_estimate : by_wheels;
}

/// A heading that is wrong from the start moves the end aside by wheels_rad_per_m · way² / 2.
bool ScanBreak::was_blind(const FollowedScan& now) const {
  if (!last_ || epoch_ != now.odometry_epoch) return false;
  const double way_m = distance_between(odom_from_robot_, now.odom_from_robot);
  return 0.5 * params_.wheels_rad_per_m * way_m * way_m > params_.least_m;
}

bool ScanBreak::observe(const FollowedScan& now) {
  const bool follows =
      last_ && epoch_ == now.odometry_epoch &&
      distance_between(odom_from_robot_, now.odom_from_robot) <= params_.most_way_m &&
      std::abs(turn_between(odom_from_robot_.theta, now.odom_from_robot.theta)) <= params_.most_turn_rad;
  std::optional<Shares> shares;
  if (follows) shares = least_compared(now);
  const bool blind = was_blind(now);
  const double passed_s = last_ ? std::max(0.0, seconds(now.scan.time - *last_)) : 0.0;
  keep(now);
  compared_over_s_ = shares ? std::optional{passed_s} : std::nullopt;
  if (!shares) return blind;
  const Shares usual = usual_.value_or(Shares{});
  const Shares more{shares->nearer - usual.nearer, shares->farther - usual.farther};
  const double most = std::min(more.nearer, more.farther) >= params_.each_way ? params_.most : params_.most_one_way;
  if (more.both() > most) return true;
  const double weight = std::min(1.0, passed_s / kUsualS);
  usual_ = Shares{usual.nearer + weight * (shares->nearer - usual.nearer),
                  usual.farther + weight * (shares->farther - usual.farther)};
  return false;
}

}  // namespace deltamap::localization::belief
