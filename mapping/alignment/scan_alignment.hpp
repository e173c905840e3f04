// SPDX-License-Identifier: Apache-2.0
// Registers the scans of S(k) consistently (paper §3.3): odometry and pairwise matches become links of a pose network,
// the localizer's first pose holds it in the map. Only scans that hang together are used: a long way on odometry alone
// tears a set apart. Where too few do there is no answer.
#pragma once

#include <optional>
#include <vector>

#include "core/messages.hpp"
#include "mapping/alignment/pose_network.hpp"
#include "mapping/alignment/scan_matching.hpp"

namespace deltamap::mapping::alignment {

struct ScanAlignmentParams {
  ScanMatchingParams matching;
  PoseNetworkParams network;
  std::size_t most_scans = 100;               ///< more are thinned evenly: bounds time and memory; > 1
  std::size_t matches_per_scan = 4;           ///< with earlier scans: the one before, and the nearest others; > 0
  double farthest_match_m = 5.0;              ///< between the poses of a matched pair
  double odometry_per_m = 0.1;                ///< σ of odometry: metres per metre driven
  double odometry_rad_per_m = 0.07;           ///< rad per metre driven (a poor robot: 4°)
  double odometry_rad_per_rad = 0.1;          ///< rad per rad turned
  double odometry_least_m = 0.02;             ///< floor of σ
  double odometry_least_rad = 0.01;           ///< floor of σ
  double most_link_deviation_m = 0.2;         ///< looser odometry does not hold scans together unless they match
  double most_link_deviation_rad = 0.05;      ///< the same in heading
  double least_anchor_deviation_m = 0.02;     ///< floor of the first pose's σ
  double least_anchor_deviation_rad = 0.005;  ///< floor of the first pose's σ
  double least_matched_share = 0.5;           ///< of the scans must be held by a match that was not dropped; [0, 1]
};

struct ScanAlignment {
  std::vector<std::size_t> scans;           ///< indices of the scans used, in order
  std::vector<Pose2> map_from_robot;        ///< of each used scan
  std::vector<PoseCovariance> covariances;  ///< of these
  std::size_t matches = 0;                  ///< pairs that were matched
};

/// Of a motion that the wheels counted, (x, y, θ).
[[nodiscard]] PoseCovariance odometry_covariance(const Pose2& motion, const ScanAlignmentParams& params);

/// Nothing where the network does not settle or too few scans match.
[[nodiscard]] std::optional<ScanAlignment> scan_alignment(const KeptScans& scans, const ScanAlignmentParams& params);

}  // namespace deltamap::mapping::alignment
