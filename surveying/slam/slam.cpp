// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/slam.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <utility>

#include "core/geometry/angle.hpp"
#include "mapping/alignment/scan_alignment.hpp"
#include "surveying/slam/submap_matcher.hpp"

namespace deltamap::surveying::slam {
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

bool begins_anew(const std::vector<Keyframe>& keyframes, std::uint32_t node) {
  return keyframes[node - 1].tracked->odometry_epoch != keyframes[node].tracked->odometry_epoch;
}

/// From the keyframe before.
mapping::alignment::PoseLink wheels_link(const std::vector<Keyframe>& keyframes, std::uint32_t node) {
  const Pose2 driven =
      motion_between(keyframes[node - 1].tracked->odom_from_robot, keyframes[node].tracked->odom_from_robot);
  const PoseCovariance covariance =
      begins_anew(keyframes, node) ? kAnywhereNear : mapping::alignment::odometry_covariance(driven, {});
  return {node - 1, node, driven, covariance, false};
}

}  // namespace

bool Slam::begins() const {
  return survey_.keyframes.empty() || survey_.keyframes.back().drive + 1 != survey_.component.size();
}

void Slam::begin_drive() {
  if (begins() && !survey_.component.empty()) return;
  end_drive();
  driven_m_ = 0.0;
  survey_.component.push_back(static_cast<std::uint32_t>(survey_.component.size()));
}

void Slam::observe(TrackedScan tracked) {
  assert(!survey_.component.empty() && "a drive has begun");
  const bool is_first = begins();
  if (!is_first) driven_m_ += distance_between(odom_from_robot_, tracked.odom_from_robot);
  odom_from_robot_ = tracked.odom_from_robot;
  if (!is_first) {
    const Pose2 moved = motion_between(survey_.keyframes.back().tracked->odom_from_robot, odom_from_robot_);
    if (moved.position().norm() < kKeyframeM && std::abs(moved.theta) < kKeyframeRad) return;
  }
  follow(keyframe(std::make_shared<const TrackedScan>(std::move(tracked)),
                  static_cast<std::uint32_t>(survey_.component.size() - 1), driven_m_),
         is_first);
}

void Slam::follow(Keyframe next, bool is_first) {
  const auto node = static_cast<std::uint32_t>(survey_.keyframes.size());
  survey_.add(std::move(next));
  if (is_first) return;
  const mapping::alignment::PoseLink by_wheels = wheels_link(survey_.keyframes, node);
  const std::optional<mapping::alignment::PoseLink> matched = matched_link(by_wheels);
  const mapping::alignment::PoseLink& link = matched ? *matched : by_wheels;
  matched_ += matched ? 1 : 0;
  survey_.poses[node] = survey_.poses[node - 1] * link.from_from_to;
  survey_.add(link);
  loops_.search_from(node);
  if (survey_.component_of(node) != 0) joining_.search_from(node);
}

/// By the last metres, about where the wheels say.
std::optional<mapping::alignment::PoseLink> Slam::matched_link(const mapping::alignment::PoseLink& by_wheels) const {
  const Keyframe& here = survey_.keyframes[by_wheels.to];
  const Pose2& driven = by_wheels.from_from_to;
  const PoseCovariance& unsure = by_wheels.covariance;
  const SearchWindow window{driven, kWheelDeviations * std::sqrt(unsure(0, 0)) + kLeastFollowedM,
                            std::min(kMostFollowedRad, kWheelDeviations * std::sqrt(unsure(2, 2)) + kLeastFollowedRad)};
  const std::uint32_t first = back_by(survey_, by_wheels.from, kFollowedM);
  const SubmapMatcher matcher{submap(survey_, first, by_wheels.from, by_wheels.from, 0.0), window.position_m};
  const bool is_after_gap = begins_anew(survey_.keyframes, by_wheels.to) || driven.position().norm() > kGapM;
  const auto match = matcher.match(here.ends, here.tracked->scan.range_deviation_m, window, {driven, unsure.inverse()},
                                   is_after_gap ? kAfterGap : kFollowing);
  if (!match) return std::nullopt;
  return mapping::alignment::PoseLink{by_wheels.from, by_wheels.to, match->submap_from_scan, match->covariance, false};
}

void Slam::end_drive() {
  if (const auto link = joining_.link()) loops_.join(*link);
}

bool Slam::finish() {
  end_drive();
  return survey_.keyframes.empty() || loops_.finish();
}

}  // namespace deltamap::surveying::slam
