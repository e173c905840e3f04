// SPDX-License-Identifier: Apache-2.0
#include "mapping/placed_scans.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "mapping/alignment/registration.hpp"
#include "mapping/alignment/surface.hpp"
#include "mapping/ray_counts.hpp"

namespace deltamap::mapping {
namespace {

alignment::PoseBelief belief_of(const Estimate& estimate, const PlacementParams& params) {
  PoseCovariance covariance = estimate.covariance;
  const double position2 = params.least_position_deviation_m * params.least_position_deviation_m;
  covariance(0, 0) += position2;
  covariance(1, 1) += position2;
  covariance(2, 2) += params.least_heading_deviation_rad * params.least_heading_deviation_rad;
  return {estimate.map_from_robot, covariance.inverse()};
}

alignment::NearestSurface surface_around(const OccupancyGrid& map, const CellBox& box,
                                         const std::function<bool(Cell)>& is_in_doubt, double reach_m) {
  std::vector<alignment::SurfacePoint> surface = alignment::contour_of(map, box);
  std::erase_if(surface, [&](const alignment::SurfacePoint& point) {
    return is_in_doubt(map.geometry().cell_at(point.position));
  });
  return alignment::NearestSurface{std::move(surface), map.resolution_m(), reach_m};
}

/// How many points have a surface in reach, wherever exactly.
std::size_t points_near(const alignment::NearestSurface& surface, const std::vector<Point2>& points,
                        const Pose2& pose) {
  return static_cast<std::size_t>(std::count_if(
      points.begin(), points.end(), [&](const Point2& point) { return surface.nearest(pose * point) != nullptr; }));
}

}  // namespace

Placement placed_scans(const OccupancyGrid& map, const std::vector<TrackedScan>& scans,
                       const std::function<bool(Cell)>& is_in_doubt, const PlacementParams& params) {
  std::vector<PlacedScan> guesses;
  for (const TrackedScan& tracked : scans) guesses.push_back({&tracked, tracked.estimate.map_from_robot});
  const int margin = static_cast<int>(std::ceil(params.reach_m / map.resolution_m()));
  const CellBox box = grown(box_seen(map.geometry(), guesses, params.longest_m), margin, map.geometry());
  const alignment::NearestSurface surface = surface_around(map, box, is_in_doubt, params.reach_m);

  Placement placement;
  Eigen::Vector3d moved_sum = Eigen::Vector3d::Zero();
  for (const PlacedScan& guess : guesses) {
    const std::vector<Point2> points = alignment::ray_ends(*guess.tracked, params.longest_m);
    const double shared =
        std::min(1.0, params.independent_points / std::max<double>(1.0, static_cast<double>(points.size())));
    const alignment::RegistrationParams registration_params{
        .most_iterations = 15,
        .first_reach_m = params.reach_m,
        .last_reach_m = std::min(params.reach_m, std::max(0.12, 2.0 * map.resolution_m())),
        .point_deviation_m = params.surface_deviation_m / std::sqrt(shared),
        .settled_m = 1e-3};
    const alignment::PoseBelief belief = belief_of(guess.tracked->estimate, params);
    const alignment::Registration found =
        alignment::registration(points, surface, guess.map_from_robot, belief, registration_params);
    const Pose2& pose = found.reference_from_moving;
    const std::size_t near = points_near(surface, points, pose);
    if (near < params.least_points) {
      placement.scans.push_back(guess);
      continue;
    }
    const Eigen::Vector3d moved = difference(guess.map_from_robot, pose);
    if (moved.dot(belief.information * moved) > params.most_chi2 ||
        static_cast<double>(found.paired) < params.least_agreement * static_cast<double>(near)) {
      ++placement.implausible;
      continue;
    }
    moved_sum += moved;
    placement.scans.push_back({guess.tracked, pose});
  }
  if (!placement.scans.empty()) moved_sum /= static_cast<double>(placement.scans.size());
  placement.mean_correction = {moved_sum.x(), moved_sum.y(), wrapped_angle(moved_sum.z())};
  return placement;
}

}  // namespace deltamap::mapping
