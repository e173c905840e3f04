// SPDX-License-Identifier: Apache-2.0
// Why shares of hits: a local map is drawn once, from few scans, and needs no model of the laser's noise. One stray
// hit among many crossings leaves a cell free, and a wall that some beams graze stays a wall.
#include "mapping/alignment/local_map.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

#include "core/grid/grid_ray.hpp"

namespace deltamap::mapping::alignment {
namespace {

struct RayInMap {
  Point2 origin;
  Point2 end;
  bool hits = false;  ///< false: cut at the longest range
};

std::vector<RayInMap> rays_in_map(std::span<const TrackedScan* const> scans, std::span<const Pose2> map_from_robot,
                                  double longest_m) {
  std::vector<RayInMap> rays;
  for (std::size_t k = 0; k < scans.size(); ++k) {
    const std::size_t count = std::min(scans[k]->rays.size(), scans[k]->scan.beams.size());
    for (std::size_t i = 0; i < count; ++i) {
      if (scans[k]->scan.beams[i].kind != BeamKind::kRange) continue;
      RayInMap ray{map_from_robot[k] * scans[k]->rays[i].origin.cast<double>().eval(),
                   map_from_robot[k] * scans[k]->rays[i].end.cast<double>().eval(), true};
      const double length_m = (ray.end - ray.origin).norm();
      if (length_m > longest_m) {
        ray.end = ray.origin + longest_m / length_m * (ray.end - ray.origin);
        ray.hits = false;
      }
      rays.push_back(ray);
    }
  }
  return rays;
}

GridGeometry geometry_around(const std::vector<RayInMap>& rays, const GridGeometry& lattice) {
  Cell first = lattice.cell_at(rays.front().origin);
  Cell last = first;
  for (const RayInMap& ray : rays) {
    for (const Point2& point : {ray.origin, ray.end}) {
      const Cell cell = lattice.cell_at(point);
      first = {std::min(first.column, cell.column), std::min(first.row, cell.row)};
      last = {std::max(last.column, cell.column), std::max(last.row, cell.row)};
    }
  }
  const Point2 origin = lattice.origin + lattice.resolution_m * Point2{first.column - 1, first.row - 1};
  return {last.column - first.column + 3, last.row - first.row + 3, lattice.resolution_m, origin};
}

}  // namespace

OccupancyGrid local_map(std::span<const TrackedScan* const> scans, std::span<const Pose2> map_from_robot,
                        const GridGeometry& lattice, const LocalMapParams& params) {
  assert(scans.size() == map_from_robot.size() && "one pose for each scan");
  const std::vector<RayInMap> rays = rays_in_map(scans, map_from_robot, params.longest_m);
  if (rays.empty()) return OccupancyGrid{{0, 0, lattice.resolution_m, lattice.origin}};
  OccupancyGrid map{geometry_around(rays, lattice)};
  const GridGeometry& geometry = map.geometry();
  std::vector<std::uint16_t> hits(geometry.cell_count(), 0);
  std::vector<std::uint16_t> crossings(geometry.cell_count(), 0);
  const auto count_up = [](std::uint16_t& counter) {
    counter = static_cast<std::uint16_t>(counter + (counter < 0xFFFF));
  };
  for (const RayInMap& ray : rays) {
    const Cell end = geometry.cell_at(ray.end);
    walk_ray(geometry, ray.origin, ray.end, [&](Cell cell, double) {
      if (geometry.contains(cell))
        count_up(ray.hits && cell == end ? hits[geometry.index_of(cell)] : crossings[geometry.index_of(cell)]);
      return true;
    });
  }
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
