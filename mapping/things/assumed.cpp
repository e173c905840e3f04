// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/assumed.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/grid/near_occupied.hpp"

namespace deltamap::mapping::things {
namespace {

constexpr int kFixingSides = 2;                        // that fix a rectangle
constexpr double kLeastSide_m = 0.6;                   // a shorter side may be the end of a face that was drawn twice
constexpr double kOfOneRectangle = 0.85;               // of the surface, on its sides
constexpr std::array kBeyondEnd_cells{2.0, 3.0, 4.0};  // where a side that ends leaves open floor
constexpr double kAlongShare = 0.8;                    // of a side, along a surface
constexpr int kSurfaceNear = 2;                        // cells between the two
constexpr double kDeep_m = 0.2;     // inside of a side: beyond pose error and a surface drawn a cell beside
constexpr double kThrough_m = 0.2;  // of a beam, deep inside
constexpr int kBeamsThrough = 3;    // of one scan; fewer are stray

/// How much of the way from one place to the other lies within the rectangle, shrunk by kDeep_m on every side.
double length_inside_m(const Outline& outline, const Point2& from, const Point2& to) {
  const Pose2 own_from_map = inverse({outline.centre.x(), outline.centre.y(), outline.heading_rad});
  const Point2 start = own_from_map * from;
  const Point2 way = own_from_map * to - start;
  const Point2 half{0.5 * outline.length_m - kDeep_m, 0.5 * outline.width_m - kDeep_m};
  double enters = 0.0;
  double leaves = 1.0;
  for (const int axis : {0, 1}) {
    if (half[axis] <= 0.0) return 0.0;
    if (std::abs(way[axis]) < 1e-9) {
      if (std::abs(start[axis]) > half[axis]) return 0.0;
      continue;
    }
    const double one = (-half[axis] - start[axis]) / way[axis];
    const double other = (half[axis] - start[axis]) / way[axis];
    enters = std::max(enters, std::min(one, other));
    leaves = std::min(leaves, std::max(one, other));
  }
  return std::max(0.0, leaves - enters) * way.norm();
}

/// A seen side leads to it, and the floor beyond that one's end is free.
bool is_where_seen_ones_end(const Outline& outline, std::size_t side, const OccupancyGrid& map) {
  const auto corner = corners(outline);
  const auto ends_free = [&](std::size_t seen_side, std::size_t at, std::size_t other_end) {
    if (!outline.seen[seen_side]) return false;
    const Point2 onward = (corner[at] - corner[other_end]).normalized() * map.resolution_m();
    return std::all_of(kBeyondEnd_cells.begin(), kBeyondEnd_cells.end(), [&](double cells) {
      return map.at(map.geometry().cell_at(corner[at] + cells * onward)) == CellState::kFree;
    });
  };
  return ends_free((side + 3) % 4, side, (side + 3) % 4) || ends_free((side + 1) % 4, (side + 1) % 4, (side + 2) % 4);
}

/// Most of it lies on or before a surface.
bool is_along_surface(const Outline& outline, std::size_t side, const OccupancyGrid& map) {
  const auto corner = corners(outline);
  const Point2 along = corner[(side + 1) % 4] - corner[side];
  const int steps = std::max(1, static_cast<int>(along.norm() / map.resolution_m()));
  int covered = 0;
  for (int i = 0; i < steps; ++i) {
    const Cell cell = map.geometry().cell_at(corner[side] + (i + 0.5) / steps * along);
    covered += has_occupied_within(map, cell, kSurfaceNear) ? 1 : 0;
  }
  return covered >= kAlongShare * steps;
}

}  // namespace

std::array<bool, 4> assumed_sides(const BodyCells& cells, const Outline& outline, const OccupancyGrid& map) {
  std::array<bool, 4> assumed{};
  if (std::count(outline.seen.begin(), outline.seen.end(), true) < kFixingSides || outline.width_m < kLeastSide_m ||
      share_on_sides(cells, outline) < kOfOneRectangle)
    return assumed;
  for (std::size_t side = 0; side < assumed.size(); ++side) {
    if (!outline.seen[side] && !is_where_seen_ones_end(outline, side, map) && !is_along_surface(outline, side, map))
      return {};
    assumed[side] = !outline.seen[side];
  }
  return assumed;
}

bool is_deep_inside(const Outline& outline, const Point2& place) { return is_inside(outline, place, -kDeep_m); }

bool goes_through(const TrackedScan& tracked, const Outline& outline) {
  const Pose2& map_from_robot = tracked.estimate.map_from_robot;
  int through = 0;
  for (const RayInRobot& ray : tracked.rays) {
    if (ray.end == ray.origin) continue;
    const Point2 from = map_from_robot * Point2{ray.origin.cast<double>()};
    const Point2 to = map_from_robot * Point2{ray.end.cast<double>()};
    through += length_inside_m(outline, from, to) >= kThrough_m ? 1 : 0;
    if (through == kBeamsThrough) return true;
  }
  return false;
}

std::vector<Cell> assumed_cells(std::span<const Thing> things, const OccupancyGrid& map) {
  std::set<std::pair<int, int>> found;  // row, column
  const GridGeometry& geometry = map.geometry();
  for (const Thing& thing : things) {
    if (!thing.at || thing.at->width_m < kOneFace_m || !is_closed(*thing.at)) continue;
    const double reach_m = 0.5 * std::hypot(thing.at->length_m, thing.at->width_m);
    const Cell first = geometry.cell_at(thing.at->centre - Point2{reach_m, reach_m});
    const Cell last = geometry.cell_at(thing.at->centre + Point2{reach_m, reach_m});
    for (int row = first.row; row <= last.row; ++row) {
      for (int column = first.column; column <= last.column; ++column) {
        const Cell cell{column, row};
        const bool is_of_it = geometry.contains(cell) && map[cell] != CellState::kOccupied &&
                              is_inside(*thing.at, geometry.centre_of(cell), 0.25 * geometry.resolution_m);
        if (is_of_it) found.emplace(row, column);
      }
    }
  }
  std::vector<Cell> cells;
  cells.reserve(found.size());
  for (const auto& [row, column] : found) cells.push_back({column, row});
  return cells;
}

}  // namespace deltamap::mapping::things
