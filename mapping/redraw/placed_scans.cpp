// SPDX-License-Identifier: Apache-2.0
// Why: the localizer's pose errs by centimetres, which is as wide as a cell: drawn at it, scans would make walls thick
// or double. What is in doubt does not count, or a scan would be pulled onto the very thing that has changed.
#include "mapping/redraw/placed_scans.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/geometry/points_in_map.hpp"
#include "core/geometry/pose_spread.hpp"
#include "core/grid/block_lattice.hpp"
#include "core/grid/tiled.hpp"
#include "mapping/redraw/ray_counts.hpp"
#include "mapping/registration/registration.hpp"
#include "mapping/registration/surface.hpp"

namespace deltamap::mapping::redraw {
namespace {

/// The places near which the scans' beams end, with room for the placement to move them: surfaces elsewhere need not be
/// known.
class PlacesOfEnds {
 public:
  PlacesOfEnds(const GridGeometry& map, double reach_m) {
    const double side_m = 0.5 * (reach_m + kMostMoved_m);  // so that two blocks reach far enough
    lattice_ = {map, std::max(1, static_cast<int>(std::ceil(side_m / map.resolution_m)))};
    const GridGeometry& blocks = lattice_.blocks();
    has_end_ = Tiled<std::uint8_t>{blocks.width, blocks.height, 0};
    is_near_end_ = has_end_;
  }

  void add(const Point2& end) {
    const GridGeometry& blocks = lattice_.blocks();
    const Cell middle = blocks.cell_at(end);
    // Outside the map there may still be a surface in reach: the map's border, for a pose that is a little off.
    if (blocks.contains(middle) && std::exchange(has_end_.to_write(middle), 1) != 0) return;
    const CellBox near = grown({middle, {middle.column + 1, middle.row + 1}}, 2, blocks);
    for (int row = near.first.row; row < near.last.row; ++row) {
      for (int column = near.first.column; column < near.last.column; ++column) {
        is_near_end_.set({column, row}, 1);
      }
    }
  }
  [[nodiscard]] bool contains(Cell cell) const { return is_near_end_[lattice_.block_of(cell)] != 0; }

 private:
  // Corrections are of some centimetres. An end that is moved farther may miss a surface that is in reach by then.
  static constexpr double kMostMoved_m = 0.2;

  BlockLattice lattice_;
  Tiled<std::uint8_t> has_end_;
  Tiled<std::uint8_t> is_near_end_;
};

/// `ends_of_scans`: of each guess, in the robot's frame.
registration::NearestSurface surface_around(const OccupancyGrid& map, const std::vector<PlacedScan>& guesses,
                                            const std::vector<std::vector<Point2>>& ends_of_scans,
                                            const std::function<bool(Cell)>& is_in_doubt,
                                            const PlacementParams& params) {
  PlacesOfEnds ends{map.geometry(), params.reach_m};
  for (std::size_t i = 0; i < guesses.size(); ++i) {
    const PointsInMap in_map{guesses[i].map_from_robot};
    for (const Point2& end : ends_of_scans[i]) ends.add(in_map(end));
  }
  const int margin = static_cast<int>(std::ceil(params.reach_m / map.resolution_m()));
  const CellBox box = grown(box_seen(map.geometry(), guesses, params.longest_m), margin, map.geometry());
  return registration::NearestSurface{
      registration::contour_of(map, box, [&](Cell cell) { return ends.contains(cell) && !is_in_doubt(cell); }),
      map.resolution_m(), params.reach_m};
}

/// How many points have a surface in reach, wherever exactly.
std::size_t points_near(const registration::NearestSurface& surface, const std::vector<Point2>& points,
                        const Pose2& pose) {
  const PointsInMap in_map{pose};
  return static_cast<std::size_t>(std::count_if(
      points.begin(), points.end(), [&](const Point2& point) { return surface.nearest(in_map(point)) != nullptr; }));
}

}  // namespace

Placement placed_scans(const OccupancyGrid& map, const KeptScans& scans, const std::function<bool(Cell)>& is_in_doubt,
                       const PlacementParams& params) {
  std::vector<PlacedScan> guesses;
  std::vector<std::vector<Point2>> ends;
  for (const std::shared_ptr<const TrackedScan>& tracked : scans) {
    guesses.push_back({tracked.get(), tracked->estimate.map_from_robot});
    ends.push_back(registration::ray_ends(*tracked, params.longest_m));
  }
  const registration::NearestSurface surface = surface_around(map, guesses, ends, is_in_doubt, params);

  Placement placement;
  for (std::size_t i = 0; i < guesses.size(); ++i) {
    const PlacedScan& guess = guesses[i];
    const std::vector<Point2>& points = ends[i];
    registration::RegistrationParams registration_params =
        registration::registration_params(points.size(), map.resolution_m(), params);
    registration_params.most_iterations = 15;
    registration_params.settled_m = 1e-3;
    const registration::PoseBelief belief{
        guess.map_from_robot, registration::floored(guess.tracked->estimate.noise_covariance(), params).inverse()};
    const registration::Registration found =
        registration::registration(points, surface, guess.map_from_robot, belief, registration_params);
    const Pose2& pose = found.reference_from_moving;
    const std::size_t near = points_near(surface, points, pose);
    if (near < params.least_points) {
      placement.scans.push_back(guess);
      continue;
    }
    const Eigen::Vector3d moved = difference(guess.map_from_robot, pose);
    if (moved.dot(belief.information * moved) > kMostChi2 ||
        static_cast<double>(found.paired) < params.least_agreement * static_cast<double>(near)) {
      ++placement.implausible;
      continue;
    }
    placement.scans.push_back({guess.tracked, pose});
  }
  return placement;
}

}  // namespace deltamap::mapping::redraw
