// SPDX-License-Identifier: Apache-2.0
#include "simulation/score/map_truth.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/grid_ray.hpp"
#include "simulation/start_map.hpp"

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

bool is_inside(const Point2& place, const Object& object) {
  if (object.kind != ObjectKind::kContainer && object.kind != ObjectKind::kPost) return false;
  return distance_between(place, object.shape) == 0.0;
}

}  // namespace

MapTruth::MapTruth(const Scenario& scenario, const OccupancyGrid& first_map)
    : floor_{scenario.robot.map_from_start.position()},
      outer_{bounds_of(scenario.world)},
      doors_{scenario.doors},
      perfect_{first_map},
      touched_(first_map.geometry().cell_count(), 0),
      last_passed_(first_map.geometry().cell_count(), 0),
      of_doors_{swept_by_doors(scenario.doors, first_map.geometry())} {
  see(scenario.world);
}

void MapTruth::see(const World& world) {
  world_ = world;
  visible_ = surveyed_map(world, floor_, perfect_.geometry());
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

std::array<double, 4> MapTruth::wall_drift(const OccupancyGrid& first, const OccupancyGrid& map) const {
  const GridGeometry& geometry = first.geometry();
  const auto mean_outwards = [&](const OccupancyGrid& grid, std::size_t wall) {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < geometry.cell_count(); ++i) {
      if (grid.cells()[i] != CellState::kOccupied) continue;
      const Point2 centre = geometry.centre_of(geometry.cell_of(i));
      const double outwards[] = {outer_.low.x() - centre.x(), centre.x() - outer_.high.x(), outer_.low.y() - centre.y(),
                                 centre.y() - outer_.high.y()};
      if (std::abs(outwards[wall]) > kWallReach_m) continue;
      sum += outwards[wall];
      ++count;
    }
    return count == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(count);
  };
  std::array<double, 4> drift{};
  for (std::size_t wall = 0; wall < 4; ++wall) drift[wall] = mean_outwards(map, wall) - mean_outwards(first, wall);
  return drift;
}

}  // namespace deltamap::simulation::score
