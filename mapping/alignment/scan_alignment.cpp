// SPDX-License-Identifier: Apache-2.0
#include "mapping/alignment/scan_alignment.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

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
  assert(before.odometry_epoch == after.odometry_epoch && "a set ends where the controller's pose jumps");
  const Pose2 motion = motion_between(before.odom_from_robot, after.odom_from_robot);
  return {from, from + 1, motion, odometry_covariance(motion, params), false};
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

bool is_tight(const PoseCovariance& covariance, const ScanAlignmentParams& params) {
  return std::sqrt(covariance.topLeftCorner<2, 2>().trace()) <= params.most_link_deviation_m &&
         std::sqrt(covariance(2, 2)) <= params.most_link_deviation_rad;
}

/// The largest group of scans that hang together by matches and by odometry that is worth something: 1 for its members.
std::vector<char> largest_group(std::uint32_t count, const std::vector<PoseLink>& links,
                                const ScanAlignmentParams& params) {
  std::vector<std::uint32_t> group(count);
  std::iota(group.begin(), group.end(), 0U);
  for (const PoseLink& link : links) {
    if (!link.may_drop && !is_tight(link.covariance, params)) continue;
    const std::uint32_t from = group[link.from];
    std::replace(group.begin(), group.end(), group[link.to], from);
  }
  std::vector<std::uint32_t> members(count, 0);
  for (const std::uint32_t label : group) ++members[label];
  const auto largest = static_cast<std::uint32_t>(std::max_element(members.begin(), members.end()) - members.begin());
  std::vector<char> is_in(count, 0);
  for (std::uint32_t i = 0; i < count; ++i) is_in[i] = group[i] == largest;
  return is_in;
}

/// What is left of the network when only the scans that `is_in` marks stay, numbered anew.
void keep_group(const std::vector<char>& is_in, std::vector<std::size_t>& scans, std::vector<Pose2>& guesses,
                std::vector<PoseLink>& links) {
  std::vector<std::uint32_t> number(is_in.size(), 0);
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < is_in.size(); ++i) {
    if (!is_in[i]) continue;
    scans[kept] = scans[i];
    guesses[kept] = guesses[i];
    number[i] = kept++;
  }
  scans.resize(kept);
  guesses.resize(kept);
  std::erase_if(links, [&](const PoseLink& link) { return !is_in[link.from] || !is_in[link.to]; });
  for (PoseLink& link : links) {
    link.from = number[link.from];
    link.to = number[link.to];
  }
}

/// Odometry from each of the `chosen` scans to the next, and the matches of each with its partners.
std::vector<PoseLink> links_of(const KeptScans& scans, const std::vector<std::size_t>& chosen,
                               const std::vector<Pose2>& guesses, const ScanAlignmentParams& params) {
  std::vector<MatchableScan> ready;
  for (const std::size_t i : chosen) ready.push_back(matchable(*scans[i], params.matching));
  std::vector<PoseLink> links;
  for (std::uint32_t i = 1; i < chosen.size(); ++i) {
    links.push_back(odometry_link(i - 1, *scans[chosen[i - 1]], *scans[chosen[i]], params));
    for (const std::uint32_t other : partners(i, guesses, params)) {
      const auto match =
          scan_match(ready[other], ready[i], motion_between(guesses[other], guesses[i]), params.matching);
      if (match) links.push_back({other, i, match->first_from_second, match->covariance, true});
    }
  }
  return links;
}

/// The first scan where it was localized, as sure as that was, but never quite.
PoseAnchor anchor_of(const TrackedScan& first, const ScanAlignmentParams& params) {
  return {
      0, first.estimate.map_from_robot,
      first.estimate.noise_covariance() + diagonal(params.least_anchor_deviation_m, params.least_anchor_deviation_rad)};
}

/// How many scans hang on a match that the network has kept.
double matched_scans(const std::vector<PoseLink>& links, const PoseNetwork& network, std::size_t scans) {
  std::vector<char> is_matched(scans, 0);
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (!links[i].may_drop || std::count(network.dropped.begin(), network.dropped.end(), i) > 0) continue;
    is_matched[links[i].from] = is_matched[links[i].to] = 1;
  }
  return static_cast<double>(std::count(is_matched.begin(), is_matched.end(), 1));
}

}  // namespace

PoseCovariance odometry_covariance(const Pose2& motion, const ScanAlignmentParams& params) {
  const double driven_m = motion.position().norm();
  const double heading_deviation_rad =
      std::max(params.odometry_least_rad,
               params.odometry_rad_per_m * driven_m + params.odometry_rad_per_rad * std::abs(motion.theta));
  return diagonal(std::max(params.odometry_least_m, params.odometry_per_m * driven_m), heading_deviation_rad);
}

std::optional<ScanAlignment> scan_alignment(const KeptScans& scans, const ScanAlignmentParams& params) {
  assert(params.matches_per_scan > 0 && params.most_scans > 1 && "parameters out of range");
  ScanAlignment alignment;
  alignment.scans = thinned(scans.size(), params.most_scans);
  if (alignment.scans.size() < 2) return std::nullopt;
  const auto count = static_cast<std::uint32_t>(alignment.scans.size());
  std::vector<Pose2> guesses;
  for (const std::size_t i : alignment.scans) guesses.push_back(scans[i]->estimate.map_from_robot);
  std::vector<PoseLink> links = links_of(scans, alignment.scans, guesses, params);
  keep_group(largest_group(count, links, params), alignment.scans, guesses, links);
  if (alignment.scans.size() < 2) return std::nullopt;
  const PoseAnchor anchor = anchor_of(*scans[alignment.scans.front()], params);
  PoseNetwork network = solved_network(guesses, links, {&anchor, 1}, params.network);
  if (!network.solved) return std::nullopt;
  alignment.matches = static_cast<std::size_t>(
      std::count_if(links.begin(), links.end(), [](const PoseLink& link) { return link.may_drop; }));
  if (matched_scans(links, network, guesses.size()) < params.least_matched_share * count) return std::nullopt;
  alignment.map_from_robot = std::move(network.poses);
  alignment.covariances = std::move(network.covariances);
  return alignment;
}

}  // namespace deltamap::mapping::alignment
