// SPDX-License-Identifier: Apache-2.0
// Why lines: two scans seldom hit the same points of a wall, so pairs of points hold a scan back along it. The
// covariance matters as much as the pose: along a corridor it has to stay wide, or the network trusts what nothing has
// observed.
#include "mapping/alignment/scan_matching.hpp"

#include <Eigen/LU>
#include <cmath>

namespace deltamap::mapping::alignment {
namespace {

constexpr double kTableCell_m = 0.1;

}  // namespace

MatchableScan matchable(const TrackedScan& tracked, const ScanMatchingParams& params) {
  std::vector<Point2> ends = registration::ray_ends(tracked, params.longest_m);
  registration::NearestSurface surface{registration::surface_of(ends), kTableCell_m, params.first_reach_m};
  return {std::move(ends), std::move(surface), tracked.scan.range_deviation_m};
}

std::optional<ScanMatch> scan_match(const MatchableScan& first, const MatchableScan& second,
                                    const Pose2& initial_first_from_second, const ScanMatchingParams& params) {
  const registration::Registration found =
      registration::registration(second.ends, first.surface, initial_first_from_second, {},
                                 {.first_reach_m = params.first_reach_m,
                                  .last_reach_m = params.last_reach_m,
                                  .point_deviation_m = second.range_deviation_m});
  if (!found.settled || second.ends.empty()) return std::nullopt;
  ScanMatch match;
  match.first_from_second = found.reference_from_moving;
  const double overlap = static_cast<double>(found.paired) / static_cast<double>(second.ends.size());
  const Pose2 correction = motion_between(initial_first_from_second, match.first_from_second);
  if (overlap < params.least_overlap || found.deviation_m > params.most_deviation_m ||
      correction.position().norm() > params.most_correction_m ||
      std::abs(correction.theta) > params.most_correction_rad) {
    return std::nullopt;
  }
  // Lu and Milios' C = s² (MᵀM)⁻¹; the floor keeps an unobserved axis finite and invertible.
  const double unobserved_m2 = params.unobserved_deviation_m * params.unobserved_deviation_m;
  const double unobserved_rad2 = params.unobserved_deviation_rad * params.unobserved_deviation_rad;
  const Eigen::Matrix3d floor =
      Eigen::Vector3d{1.0 / unobserved_m2, 1.0 / unobserved_m2, 1.0 / unobserved_rad2}.asDiagonal();
  match.covariance = (params.independent_share * found.information + floor).inverse();
  return match;
}

}  // namespace deltamap::mapping::alignment
