// SPDX-License-Identifier: Apache-2.0
#include "simulation/score/map_truth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/grid/grid_ray.hpp"
#include "simulation/scenario/start_map.hpp"

namespace deltamap::simulation::score {
namespace {

constexpr double kDoorRoom_m = 0.15;     // beside a leaf in any position
constexpr double kWallReach_m = 0.3;     // how far off a wall's cells are looked for
constexpr double kBeyondSurface = 0.25;  // of a cell: a hit lies in the cell behind the surface's edge

CellMask swept_by_doors(const std::vector<DoorParams>& doors, const GridGeometry& geometry) {
  CellMask swept(geometry.cell_count(), 0);
  for (const DoorParams& door : doors) {
    for (int step = 0; step <= 20; ++step) {
      const auto leaf = leaf_of(door, 0.05 * step);
      if (!leaf) continue;
      for (std::size_t i = 0; i < swept.size(); ++i) {
        if (distance_between(geometry.centre_of(geometry.cell_of(i)), *leaf) <= kDoorRoom_m) swept[i] = 1;
      }
    }
  }
  return swept;
}

std::vector<Segment> outer_walls(const World& world) {
  const Polyline* first = world.objects.empty() ? nullptr : std::get_if<Polyline>(&world.objects.front().shape);
  if (first != nullptr && first->points.size() > 3 && first->points.front() == first->points.back()) {
    return segments_of(*first);
  }
  const Bounds bounds = bounds_of(world);
  const Point2 size = bounds.high - bounds.low;
  return segments_of(Box{bounds.low + 0.5 * size, size.x(), size.y(), 0.0});
}

bool is_inside(const Point2& place, const Object& object) {
  if (object.kind != ObjectKind::kContainer && object.kind != ObjectKind::kPost) return false;
  return distance_between(place, object.shape) == 0.0;
}

}  // namespace

MapTruth::MapTruth(const Scenario& scenario, const OccupancyGrid& first_map)
    : floor_{scenario.robot.map_from_start.position()},
      outer_{outer_walls(scenario.world)},
      doors_{scenario.doors},
      perfect_{first_map},
      touched_(first_map.geometry().cell_count(), 0),
      last_passed_(first_map.geometry().cell_count(), 0),
      of_doors_{swept_by_doors(scenario.doors, first_map.geometry())} {
  see(scenario.world);
}

void MapTruth::see(const World& world) {
  world_ = world;
  visible_ = surveyed_map(world, uncovered_floor(), perfect_.geometry());
}

/// Where the robot started, or, where a thing stands there now, the nearest place that was floor until now.
Point2 MapTruth::uncovered_floor() const {
  const GridGeometry& geometry = perfect_.geometry();
  const auto is_covered = [&](const Point2& place) {
    return std::any_of(world_.objects.begin(), world_.objects.end(), [&](const Object& object) {
      return object.kind != ObjectKind::kWall && distance_between(place, object.shape) < geometry.resolution_m;
    });
  };
  if (visible_.box().empty() || !is_covered(floor_)) return floor_;
  Point2 nearest = floor_;
  double nearest_m = std::numeric_limits<double>::infinity();
  for_each_known(visible_, [&](Cell cell, CellState state) {
    if (state != CellState::kFree) return;
    const Point2 place = geometry.centre_of(cell);
    const double away_m = (place - floor_).norm();
    if (away_m >= nearest_m || is_covered(place)) return;
    nearest = place;
    nearest_m = away_m;
  });
  return nearest;
}

void MapTruth::touch(std::span<const TrueBeam> view) {
  const GridGeometry& geometry = perfect_.geometry();
  for (const TrueBeam& beam : view) {
    const double length_m = beam.range_m + (beam.hit ? kBeyondSurface * geometry.resolution_m : 0.0);
    const Point2 end = beam.from + length_m * Point2{std::cos(beam.bearing_rad), std::sin(beam.bearing_rad)};
    const double clear_m = beam.range_m - geometry.resolution_m;
    walk_ray(geometry, beam.from, end, [&](Cell cell, double entered_m) {
      if (!geometry.contains(cell)) return false;
      const std::size_t index = geometry.index_of(cell);
      touched_[index] = 1;
      last_passed_[index] = entered_m < clear_m ? 1 : 0;
      if (visible_[cell] != CellState::kUnknown) perfect_.set(cell, visible_[cell]);
      return true;
    });
  }
}

OccupancyGrid MapTruth::solid() const {
  OccupancyGrid solid = visible_;
  const GridGeometry& geometry = solid.geometry();
  for (const Object& object : world_.objects) {
    if (object.kind != ObjectKind::kContainer && object.kind != ObjectKind::kPost) continue;
    CellBox box;
    for (const Cell cell : surface_cells(object.shape, geometry)) {
      if (box.empty()) box = {cell, {cell.column + 1, cell.row + 1}};
      box = {{std::min(box.first.column, cell.column), std::min(box.first.row, cell.row)},
             {std::max(box.last.column, cell.column + 1), std::max(box.last.row, cell.row + 1)}};
    }
    for (int row = box.first.row; row < box.last.row; ++row) {
      for (int column = box.first.column; column < box.last.column; ++column) {
        const Cell cell{column, row};
        if (geometry.contains(cell) && is_inside(geometry.centre_of(cell), object))
          solid.set(cell, CellState::kOccupied);
      }
    }
  }
  return solid;
}

CellMask MapTruth::seen() const {
  CellMask seen = grown(touched_, perfect_.geometry());
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = static_cast<std::uint8_t>(seen[i] & (1 - of_doors_[i]));
  return seen;
}

CellMask MapTruth::surfaces_of(Material material) const {
  const GridGeometry& geometry = perfect_.geometry();
  CellMask lasting(geometry.cell_count(), 0);
  for (const Object& object : world_.objects) {
    if (object.kind == ObjectKind::kContainer || object.kind == ObjectKind::kDoor) continue;
    if (object.material != material) continue;
    for (const Cell cell : surface_cells(object.shape, geometry)) {
      if (geometry.contains(cell) && of_doors_[geometry.index_of(cell)] == 0) lasting[geometry.index_of(cell)] = 1;
    }
  }
  return lasting;
}

CellMask MapTruth::seen_through() const {
  CellMask mask = surfaces_of(Material::kGlass);
  const CellMask wrapped = surfaces_of(Material::kWrap);
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = static_cast<std::uint8_t>(mask[i] | wrapped[i]);
  return mask;
}

std::vector<double> MapTruth::wall_drift(const OccupancyGrid& first, const OccupancyGrid& map) const {
  const GridGeometry& geometry = first.geometry();
  const auto mean_offset_m = [&](const OccupancyGrid& grid, const Segment& wall) {
    const double length_m = (wall.to - wall.from).norm();
    const Point2 along = (wall.to - wall.from) / length_m;
    double sum_m = 0.0;
    std::size_t count = 0;
    for_each_known(grid, [&](Cell cell, CellState state) {
      if (state != CellState::kOccupied) return;
      const Point2 offset = geometry.centre_of(cell) - wall.from;
      const double to_right_m = offset.x() * along.y() - offset.y() * along.x();
      const double share_m = offset.dot(along);
      if (std::abs(to_right_m) > kWallReach_m || share_m < -kWallReach_m || share_m > length_m + kWallReach_m) return;
      sum_m += to_right_m;
      ++count;
    });
    return count == 0 ? std::numeric_limits<double>::quiet_NaN() : sum_m / static_cast<double>(count);
  };
  std::vector<double> drift_m;
  for (const Segment& wall : outer_) drift_m.push_back(mean_offset_m(map, wall) - mean_offset_m(first, wall));
  return drift_m;
}

}  // namespace deltamap::simulation::score
