// SPDX-License-Identifier: Apache-2.0
#include "mapping/slam/slam.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <utility>

#include "core/geometry/angle.hpp"
#include "mapping/alignment/scan_alignment.hpp"
#include "mapping/slam/submap_matcher.hpp"

namespace deltamap::mapping::slam {
namespace {

constexpr double kKeyframeM = 0.25;
constexpr double kKeyframeRad = radians(8.0);
constexpr double kFollowedM = 6.0;  // of the way so far that a keyframe is matched against
constexpr double kWheelDeviations = 3.0;
constexpr double kLeastFollowedM = 0.1;
constexpr double kLeastFollowedRad = 0.03;
constexpr double kMostFollowedRad = 0.6;
constexpr SubmapMatchParams kFollowing{.inner_deviation_m = 0.002, .inner_deviation_rad = 0.0005};
// Metres without a scan: the wheels tell little, and what is in view may be another place that looks alike.
constexpr double kGapM = 1.0;
constexpr SubmapMatchParams kAfterGap{.least_score = 0.5,
                                      .least_paired = 0.5,
                                      .ambiguous_share = 0.85,
                                      .inner_deviation_m = 0.01,
                                      .inner_deviation_rad = 0.002};

/// The controller has begun anew: what the robot did meanwhile is known to nobody.
const PoseCovariance kAnywhereNear = Eigen::Vector3d{0.25, 0.25, 0.09}.asDiagonal();

}  // namespace

void Slam::begin_drive() {
  if (begins_ && !survey_.component.empty()) return;  // of the last one nothing has been seen yet
  end_drive();
  begins_ = true;
  driven_m_ = 0.0;
  survey_.component.push_back(static_cast<std::uint32_t>(survey_.component.size()));
}

void Slam::observe(TrackedScan tracked) {
  assert(!survey_.component.empty() && "a drive has begun");
  const Pose2 odom_from_robot = tracked.odom_from_robot;
  if (!begins_) {
    driven_m_ += distance_between(odom_from_robot_, odom_from_robot);
    const Pose2 moved = motion_between(survey_.keyframes.back().tracked->odom_from_robot, odom_from_robot);
    odom_from_robot_ = odom_from_robot;
    if (moved.position().norm() < kKeyframeM && std::abs(moved.theta) < kKeyframeRad) return;
  }
  odom_from_robot_ = odom_from_robot;
  begins_ = false;
  follow(keyframe(std::make_shared<const TrackedScan>(std::move(tracked)),
                  static_cast<std::uint32_t>(survey_.component.size() - 1), driven_m_));
}

void Slam::follow(Keyframe next) {
  const auto node = static_cast<std::uint32_t>(survey_.keyframes.size());
  const bool is_first = node == 0 || survey_.keyframes.back().drive != next.drive;
  survey_.add(std::move(next));
  if (is_first) return;
  bool is_matched = false;
  const alignment::PoseLink link = followed(node, is_matched);
  matched_ += is_matched ? 1 : 0;
  survey_.poses[node] = survey_.poses[node - 1] * link.from_from_to;
  survey_.add(link);
  loops_.search_from(node);
  if (survey_.component_of(node) != 0) joining_.search_from(node);
}

/// From the keyframe before.
alignment::PoseLink Slam::followed(std::uint32_t node, bool& is_matched) const {
  const std::uint32_t before = node - 1;
  const Keyframe& here = survey_.keyframes[node];
  const Pose2 driven =
      motion_between(survey_.keyframes[before].tracked->odom_from_robot, here.tracked->odom_from_robot);
  const bool is_known = survey_.keyframes[before].tracked->odometry_epoch == here.tracked->odometry_epoch;
  const PoseCovariance by_wheels = is_known ? alignment::odometry_covariance(driven, {}) : kAnywhereNear;
  const SearchWindow window{
      driven, kWheelDeviations * std::sqrt(by_wheels(0, 0)) + kLeastFollowedM,
      std::min(kMostFollowedRad, kWheelDeviations * std::sqrt(by_wheels(2, 2)) + kLeastFollowedRad)};
  const SubmapMatcher matcher{submap(survey_, back_by(survey_, before, kFollowedM), before, before, 0.0),
                              window.position_m};
  const auto match =
      matcher.match(here.ends, here.tracked->scan.range_deviation_m, window, {driven, by_wheels.inverse()},
                    !is_known || driven.position().norm() > kGapM ? kAfterGap : kFollowing);
  is_matched = match.has_value();
  if (!match) return {before, node, driven, by_wheels, false};
  return {before, node, match->submap_from_scan, match->covariance, false};
}

void Slam::end_drive() {
  if (const auto link = joining_.link()) loops_.join(*link);
}

bool Slam::finish() {
  end_drive();
  return survey_.keyframes.empty() || loops_.finish();
}

}  // namespace deltamap::mapping::slam
