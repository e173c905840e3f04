// SPDX-License-Identifier: Apache-2.0
#include "mapping/alignment/scan_alignment.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace deltamap::mapping::alignment {
namespace {

std::vector<std::size_t> thinned(std::size_t count, std::size_t most) {
  std::vector<std::size_t> kept(std::min(count, most));
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = kept.size() < 2 ? 0 : i * (count - 1) / (kept.size() - 1);
  return kept;
}

PoseCovariance diagonal(double position_deviation_m, double heading_deviation_rad) {
  const double position2 = position_deviation_m * position_deviation_m;
  return Eigen::Vector3d{position2, position2, heading_deviation_rad * heading_deviation_rad}.asDiagonal();
}

PoseLink odometry_link(std::uint32_t from, const TrackedScan& before, const TrackedScan& after,
                       const ScanAlignmentParams& params) {
  const Pose2 motion = motion_between(before.odom_from_robot, after.odom_from_robot);
  const double driven_m = motion.position().norm();
  const double heading_deviation_rad =
      std::max(params.odometry_least_rad,
               params.odometry_rad_per_m * driven_m + params.odometry_rad_per_rad * std::abs(motion.theta));
  return {from, from + 1, motion,
          diagonal(std::max(params.odometry_least_m, params.odometry_per_m * driven_m), heading_deviation_rad), false};
}

/// The scan before, and the nearest of the earlier ones within reach.
std::vector<std::uint32_t> partners(std::uint32_t scan, const std::vector<Pose2>& poses,
                                    const ScanAlignmentParams& params) {
  std::vector<std::uint32_t> near;
  for (std::uint32_t other = 0; other + 1 < scan; ++other) {
    if (distance_between(poses[other], poses[scan]) <= params.farthest_match_m) near.push_back(other);
  }
  // Heading counts as distance: a laser that sees half the world shares little with one turned away.
  const auto apart = [&](std::uint32_t other) {
    return distance_between(poses[other], poses[scan]) + std::abs(turn_between(poses[other].theta, poses[scan].theta));
  };
  std::stable_sort(near.begin(), near.end(), [&](auto a, auto b) { return apart(a) < apart(b); });
  if (near.size() + 1 > params.matches_per_scan) near.resize(params.matches_per_scan - 1);
  near.push_back(scan - 1);
  return near;
}

bool odometry_is_usable(const TrackedScan& before, const TrackedScan& after) {
  return before.odometry_epoch == after.odometry_epoch;
}

}  // namespace

std::optional<ScanAlignment> scan_alignment(std::span<const TrackedScan> scans, const ScanAlignmentParams& params) {
  assert(params.matches_per_scan > 0 && params.most_scans > 1 && "parameters out of range");
  ScanAlignment alignment;
  alignment.scans = thinned(scans.size(), params.most_scans);
  if (alignment.scans.size() < 2) return std::nullopt;
  const auto count = static_cast<std::uint32_t>(alignment.scans.size());
  const auto scan_at = [&](std::uint32_t i) -> const TrackedScan& { return scans[alignment.scans[i]]; };

  std::vector<Pose2> guesses;
  std::vector<MatchableScan> ready;
  for (std::uint32_t i = 0; i < count; ++i) {
    guesses.push_back(scan_at(i).estimate.map_from_robot);
    ready.push_back(matchable(scan_at(i), params.matching));
  }
  std::vector<PoseLink> links;
  for (std::uint32_t i = 1; i < count; ++i) {
    if (odometry_is_usable(scan_at(i - 1), scan_at(i))) {
      links.push_back(odometry_link(i - 1, scan_at(i - 1), scan_at(i), params));
    }
    for (const std::uint32_t other : partners(i, guesses, params)) {
      const auto match =
          scan_match(ready[other], ready[i], motion_between(guesses[other], guesses[i]), params.matching);
      if (match) links.push_back({other, i, match->first_from_second, match->covariance, true});
    }
  }
  const PoseAnchor anchor{
      0, guesses.front(),
      scan_at(0).estimate.covariance + diagonal(params.least_anchor_deviation_m, params.least_anchor_deviation_rad)};
  PoseNetwork network = solved_network(guesses, links, {&anchor, 1}, params.network);
  if (!network.solved) return std::nullopt;

  std::vector<char> is_matched(count, 0);
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (!links[i].may_drop) continue;
    ++alignment.matches;
    if (std::count(network.dropped.begin(), network.dropped.end(), i) > 0) continue;
    is_matched[links[i].from] = is_matched[links[i].to] = 1;
  }
  const auto matched = static_cast<double>(std::count(is_matched.begin(), is_matched.end(), 1));
  if (matched < params.least_matched_share * count) return std::nullopt;
  alignment.dropped = network.dropped.size();
  alignment.map_from_robot = std::move(network.poses);
  alignment.covariances = std::move(network.covariances);
  return alignment;
}

}  // namespace deltamap::mapping::alignment
