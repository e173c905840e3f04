// SPDX-License-Identifier: Apache-2.0
// The merge of two grids with a prior.
#include <cassert>

#include "mapping/merge/best_nearby.hpp"
#include "mapping/merge/border_registration.hpp"
#include "mapping/merge/edge_registration.hpp"
#include "mapping/merge/prior_merge.hpp"
#include "mapping/merge/thinned.hpp"

namespace deltamap::mapping::merge {
namespace {

constexpr std::size_t kContourPoints = 250;    // of the local contour, to be brought onto the map's
constexpr std::size_t kRoughEdgeCells = 2500;  // to come near, before more of them count
constexpr double kRoughlySettled_cells = 0.02;
constexpr std::size_t kMostEdgeCells = 12000;  // at the end

}  // namespace

PriorMerge prior_merge(const OccupancyGrid& map, const OccupancyGrid& local, const Pose2& map_from_local_guess,
                       const PoseCovariance& covariance, const PriorMergeParams& params) {
  assert(map.resolution_m() == local.resolution_m() && "both maps must have the same resolution");
  const double resolution_m = map.resolution_m();
  const std::vector<Cell> contour = contour_cells(local);
  const Point2 middle = middle_of(contour, local);
  const Point2 middle_in_local = local.geometry().origin + resolution_m * middle;
  std::vector<Point2> points;
  for (const Cell& cell : thinned_to(contour, kContourPoints))
    points.emplace_back(map_from_local_guess * local.geometry().centre_of(cell));
  PriorMerge merge = prior_merge(map, points, {map_from_local_guess * middle_in_local, covariance}, params);
  if (!merge.accepted()) return merge;

  const Pose2 rough = merge.map_from_guess * map_from_local_guess;
  const std::vector<EdgeCell> edges = thinned_to(edge_cells(local, contour, middle), kMostEdgeCells);
  CellMotion motion = cell_motion(rough, map.geometry(), middle_in_local);
  motion = edge_registration(map, thinned_to(edges, kRoughEdgeCells), motion, {.settled_cells = kRoughlySettled_cells});
  motion = border_registration(map, edges, motion, {});
  motion = best_nearby(map, edges, motion);
  merge.map_from_guess = map_from_local(motion, map.geometry(), middle_in_local) * inverse(map_from_local_guess);
  return merge;
}

}  // namespace deltamap::mapping::merge
