// SPDX-License-Identifier: Apache-2.0
// Why shares of hits: a local map is drawn once, from few scans, and needs no model of the laser's noise. One stray
// hit among many crossings leaves a cell free, and a wall that some beams graze stays a wall.
#include "mapping/alignment/local_map.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

#include "core/geometry/points_in_map.hpp"
#include "core/grid/grid_ray.hpp"

namespace deltamap::mapping::alignment {
namespace {

struct RayInMap {
  Point2 origin;
  Point2 end;
  bool hits = false;  ///< false: cut at the longest range
};

RayInMap ray_in_map(const PointsInMap& in_map, const RayInRobot& ray_in_robot, double longest_m) {
  RayInMap ray{in_map(ray_in_robot.origin), in_map(ray_in_robot.end), true};
  const double length_m = (ray.end - ray.origin).norm();
  if (length_m > longest_m) {
    ray.end = ray.origin + longest_m / length_m * (ray.end - ray.origin);
    ray.hits = false;
  }
  return ray;
}

/// `visit(RayInMap)` for each beam with a range.
template <typename Visit>
void for_each_ray(const ScanSource& scan_at, std::span<const Pose2> map_from_robot, double longest_m, Visit&& visit) {
  for (std::size_t k = 0; k < map_from_robot.size(); ++k) {
    const TrackedScan& tracked = scan_at(k);
    const PointsInMap in_map{map_from_robot[k]};
    const std::size_t count = std::min(tracked.rays.size(), tracked.scan.beams.size());
    for (std::size_t i = 0; i < count; ++i) {
      if (tracked.scan.beams[i].kind == BeamKind::kRange) visit(ray_in_map(in_map, tracked.rays[i], longest_m));
    }
  }
}

/// The cells that rays touch.
class TouchedBox {
 public:
  explicit TouchedBox(const GridGeometry& lattice) : lattice_{lattice} {}
  void add(const Point2& place) {
    const Cell cell = lattice_.cell_at(place);
    if (is_empty_) first_ = last_ = cell;
    is_empty_ = false;
    first_ = {std::min(first_.column, cell.column), std::min(first_.row, cell.row)};
    last_ = {std::max(last_.column, cell.column), std::max(last_.row, cell.row)};
  }
  /// With a cell more on each side; none where nothing was touched.
  [[nodiscard]] GridGeometry geometry() const {
    if (is_empty_) return {0, 0, lattice_.resolution_m, lattice_.origin};
    const Point2 origin = lattice_.origin + lattice_.resolution_m * Point2{first_.column - 1, first_.row - 1};
    return {last_.column - first_.column + 3, last_.row - first_.row + 3, lattice_.resolution_m, origin};
  }

 private:
  const GridGeometry& lattice_;
  Cell first_;
  Cell last_;
  bool is_empty_ = true;
};

}  // namespace

OccupancyGrid local_map(std::span<const TrackedScan* const> scans, std::span<const Pose2> map_from_robot,
                        const GridGeometry& lattice, const LocalMapParams& params) {
  assert(scans.size() == map_from_robot.size() && "one pose for each scan");
  const ScanSource scan_at = [&](std::size_t k) -> const TrackedScan& { return *scans[k]; };
  return local_map(scan_at, map_from_robot, lattice, params);
}

OccupancyGrid local_map(const ScanSource& scan_at, std::span<const Pose2> map_from_robot, const GridGeometry& lattice,
                        const LocalMapParams& params) {
  TouchedBox touched{lattice};
  for_each_ray(scan_at, map_from_robot, params.longest_m, [&](const RayInMap& ray) {
    touched.add(ray.origin);
    touched.add(ray.end);
  });
  OccupancyGrid map{touched.geometry()};
  const GridGeometry& geometry = map.geometry();
  std::vector<std::uint16_t> hits(geometry.cell_count(), 0);
  std::vector<std::uint16_t> crossings(geometry.cell_count(), 0);
  const auto count_up = [](std::uint16_t& counter) {
    counter = static_cast<std::uint16_t>(counter + (counter < 0xFFFF));
  };
  for_each_ray(scan_at, map_from_robot, params.longest_m, [&](const RayInMap& ray) {
    const Cell end = geometry.cell_at(ray.end);
    walk_ray(geometry, ray.origin, ray.end, [&](Cell cell, double) {
      if (geometry.contains(cell))
        count_up(ray.hits && cell == end ? hits[geometry.index_of(cell)] : crossings[geometry.index_of(cell)]);
      return true;
    });
  });
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const double looks = hits[i] + crossings[i];
    if (hits[i] >= params.least_hits && hits[i] >= params.least_hit_share * looks) {
      map.set(geometry.cell_of(i), CellState::kOccupied);
    } else if (crossings[i] > 0) {
      map.set(geometry.cell_of(i), CellState::kFree);
    }
  }
  return map;
}

}  // namespace deltamap::mapping::alignment
