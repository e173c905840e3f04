// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/slam.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/geometry/angle.hpp"
#include "surveying/slam/submap_matcher.hpp"

namespace deltamap::surveying::slam {
namespace {

constexpr double kKeyframeM = 0.25;
constexpr double kKeyframeRad = radians(8.0);
constexpr double kFollowedM = 6.0;  // of the way so far that a keyframe is matched against
constexpr double kWidened = 2.0;    // times, where the best match lies at the window's rim
constexpr int kMostLooks = 4;
constexpr SubmapMatchParams kFollowing{.inner_deviation_m = 0.002, .inner_deviation_rad = 0.0005};
// Metres without a scan, or farther than expected: what is in view may be another place that looks alike.
constexpr double kGapM = 1.0;
constexpr SubmapMatchParams kGuessed{.least_score = 0.5,
                                     .least_paired = 0.5,
                                     .ambiguous_share = 0.85,
                                     .inner_deviation_m = 0.01,
                                     .inner_deviation_rad = 0.002};

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

void Slam::observe(const MovedScan& moved) {
  assert(!survey_.component.empty() && "a drive has begun");
  const bool is_first = begins();
  if (!is_first) {
    driven_m_ += distance_between(odom_from_robot_, moved.tracked.odom_from_robot);
    since_keyframe_.go_on(moved);
  }
  odom_from_robot_ = moved.tracked.odom_from_robot;
  const Pose2& motion = since_keyframe_.keyframe_from_robot();
  if (!is_first && motion.position().norm() < kKeyframeM && std::abs(motion.theta) < kKeyframeRad) return;
  const auto node = static_cast<std::uint32_t>(survey_.keyframes.size());
  const mapping::alignment::PoseLink link{node - 1, node, motion, since_keyframe_.covariance(), false};
  since_keyframe_.begin(moved);
  const Keyframe* const like = survey_.keyframes.empty() ? nullptr : &survey_.keyframes.back();
  survey_.add(keyframe(moved.tracked, static_cast<std::uint32_t>(survey_.component.size() - 1), driven_m_, like));
  if (!is_first) follow(link);
}

void Slam::follow(const mapping::alignment::PoseLink& moved) {
  const std::optional<mapping::alignment::PoseLink> matched = matched_link(moved);
  const mapping::alignment::PoseLink& link = matched ? *matched : moved;
  matched_ += matched ? 1 : 0;
  survey_.poses[link.to] = survey_.poses[link.from] * link.from_from_to;
  survey_.add(link);
  loops_.search_from(link.to);
  if (survey_.component_of(link.to) != 0) joining_.search_from(link.to);
}

/// By the last metres, about where wheels and scans together say. Where nothing fits there, or the best lies at the
/// window's rim, a wider one is searched.
std::optional<mapping::alignment::PoseLink> Slam::matched_link(const mapping::alignment::PoseLink& moved) const {
  const Keyframe& here = survey_.keyframes[moved.to];
  const Pose2& motion = moved.from_from_to;
  const std::uint32_t first = back_by(survey_, moved.from, kFollowedM);
  SubmapMatcher matcher{submap(survey_, first, moved.from, moved.from, 0.0),
                        window_of(motion, moved.covariance).position_m};
  const std::vector<Point2> ends = here.ends();
  PoseCovariance unsure = moved.covariance;
  for (int looks = 0; looks < kMostLooks; ++looks, unsure *= kWidened * kWidened) {
    const bool is_guessed = looks > 0 || motion.position().norm() > kGapM;
    const auto match = matcher.match(ends, here.scan.range_deviation_m(), window_of(motion, unsure),
                                     {motion, unsure.inverse()}, is_guessed ? kGuessed : kFollowing);
    if (!match || match->is_at_rim) continue;
    return mapping::alignment::PoseLink{moved.from, moved.to, match->submap_from_scan, match->covariance, false};
  }
  return std::nullopt;
}

void Slam::end_drive() {
  if (const auto link = joining_.link()) loops_.join(*link);
}

bool Slam::finish() {
  end_drive();
  return survey_.keyframes.empty() || loops_.finish();
}

}  // namespace deltamap::surveying::slam
