// SPDX-License-Identifier: Apache-2.0
#include "mapping/paper/paper_update.hpp"

#include "core/geometry/pose_spread.hpp"
#include "mapping/registration/acceptance.hpp"
#include "mapping/registration/transformed_grid.hpp"

namespace deltamap::mapping::paper {
namespace {

OccupancyGrid drawn(const ScanSet& set, const alignment::ScanAlignment& aligned, const GridGeometry& lattice,
                    const alignment::LocalMapParams& params) {
  std::vector<const TrackedScan*> scans;
  scans.reserve(aligned.scans.size());
  for (const std::size_t scan : aligned.scans) scans.push_back(set.scans[scan].get());
  return alignment::local_map(scans, aligned.map_from_robot, lattice, params);
}

/// χ² of the merge's correction at the middle one of the aligned poses.
double chi2_of(const Pose2& map_from_local, const alignment::ScanAlignment& aligned, double resolution_m,
               const PaperUpdateParams& params) {
  const std::size_t middle = aligned.scans.size() / 2;
  const Pose2& before = aligned.map_from_robot[middle];
  const Pose2 after = map_from_local * before;
  const double shift_deviation_m = params.merge_deviation_cells * resolution_m;
  const double shift2 = shift_deviation_m * shift_deviation_m;
  const PoseCovariance covariance =
      aligned.covariances[middle] +
      PoseCovariance{
          Eigen::Vector3d{shift2, shift2, params.merge_deviation_rad * params.merge_deviation_rad}.asDiagonal()};
  return squared_deviations(difference(before, after), covariance);
}

}  // namespace

scan_set::MapUpdate paper_update(const OccupancyGrid& map, const ScanSet& set, const PaperUpdateParams& params) {
  scan_set::MapUpdate update;
  const auto refused = [&update](scan_set::Refusal refusal) {
    update.refusal = refusal;
    return update;
  };
  if (set.scans.size() < params.least_scans) return refused(scan_set::Refusal::kTooFewScans);
  const auto aligned = alignment::scan_alignment(set.scans, params.alignment);
  if (!aligned || aligned->scans.size() < params.least_scans) return refused(scan_set::Refusal::kNoAlignment);

  const OccupancyGrid local = drawn(set, *aligned, map.geometry(), params.local_map);
  const merge::MapMerge merged = merge::map_merge(map, local, params.merge);
  update.acceptance = merged.score.acceptance();
  if (!merged.accepted()) return refused(scan_set::Refusal::kNoMerge);

  const OccupancyGrid moved = registration::transformed_grid(local, merged.map_from_local, map.geometry());
  update.acceptance = registration::acceptance(map, moved).value();
  if (update.acceptance < params.least_acceptance) return refused(scan_set::Refusal::kLowAcceptance);
  if (params.refuse_implausible && chi2_of(merged.map_from_local, *aligned, map.resolution_m(), params) > kMostChi2) {
    return refused(scan_set::Refusal::kImplausible);
  }
  update.changes = changes_between(map, registration::overridden(map, moved));
  return update.changes.empty() ? refused(scan_set::Refusal::kNothingChanged) : update;
}

}  // namespace deltamap::mapping::paper
