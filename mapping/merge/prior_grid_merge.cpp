// SPDX-License-Identifier: Apache-2.0
// The merge of two grids with a prior.
#include <cassert>

#include "mapping/merge/edge_registration.hpp"
#include "mapping/merge/prior_merge.hpp"

namespace deltamap::mapping::merge {
namespace {

constexpr std::size_t kContourPoints = 400;    // of the local contour, to be brought onto the map's
constexpr std::size_t kRoughEdgeCells = 2500;  // to come near, before more of them count
constexpr std::size_t kMostEdgeCells = 12000;
constexpr double kNearbyStep_cells = 0.04;
constexpr int kNearbyRounds = 6;

template <typename T>
std::vector<T> thinned_to(std::span<const T> all, std::size_t most) {
  const std::size_t stride = all.size() / most + 1;
  std::vector<T> left;
  left.reserve(all.size() / stride + 1);
  for (std::size_t i = 0; i < all.size(); i += stride) left.push_back(all[i]);
  return left;
}

}  // namespace

PriorMerge prior_merge(const OccupancyGrid& map, const OccupancyGrid& local, const Pose2& map_from_local_guess,
                       const PoseCovariance& covariance, const PriorMergeParams& params) {
  assert(map.resolution_m() == local.resolution_m() && "both maps must have the same resolution");
  const double resolution_m = map.resolution_m();
  const std::vector<Cell> contour = contour_cells(local);
  const Point2 middle = middle_of(contour, local);
  const Point2 middle_in_local = local.geometry().origin + resolution_m * middle;
  std::vector<Point2> points;
  for (const Cell& cell : thinned_to<Cell>(contour, kContourPoints))
    points.emplace_back(map_from_local_guess * local.geometry().centre_of(cell));
  PriorMerge merge = prior_merge(map, points, {map_from_local_guess * middle_in_local, covariance}, params);
  if (!merge.accepted()) return merge;

  const Pose2 rough = merge.map_from_guess * map_from_local_guess;
  const Point2 rough_middle = (rough * middle_in_local - map.geometry().origin) / resolution_m;
  const std::vector<EdgeCell> edges = thinned_to<EdgeCell>(edge_cells(local, contour, middle), kMostEdgeCells);
  CellMotion motion{rough.theta, rough_middle.x(), rough_middle.y()};
  motion = edge_registration(map, thinned_to<EdgeCell>(edges, kRoughEdgeCells), motion, {});
  motion = edge_registration(map, edges, motion, {});
  motion = best_nearby(map, edges, motion, kNearbyStep_cells, kNearbyRounds);
  const Point2 middle_in_map = map.geometry().origin + resolution_m * Point2{motion.column, motion.row};
  const Pose2 map_from_local = Pose2{middle_in_map.x(), middle_in_map.y(), wrapped_angle(motion.turn_rad)} *
                               inverse(Pose2{middle_in_local.x(), middle_in_local.y(), 0.0});
  merge.map_from_guess = map_from_local * inverse(map_from_local_guess);
  return merge;
}

}  // namespace deltamap::mapping::merge
