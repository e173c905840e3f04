// SPDX-License-Identifier: Apache-2.0
#include "simulation/scenario/start_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/grid/grid_ray.hpp"

namespace deltamap::simulation {
namespace {

constexpr double kMargin_m = 1.0;  // unknown space around the world

GridGeometry map_geometry(const World& world, double resolution_m) {
  const Bounds bounds = bounds_of(world);
  const Point2 size = bounds.high - bounds.low + Point2::Constant(2.0 * kMargin_m);
  const Point2 low = bounds.low - Point2::Constant(kMargin_m);
  // Cell borders lie half a cell beside the round coordinates.
  const Point2 origin{std::floor(low.x() / resolution_m + 0.5) * resolution_m - 0.5 * resolution_m,
                      std::floor(low.y() / resolution_m + 0.5) * resolution_m - 0.5 * resolution_m};
  return {static_cast<int>(std::ceil(size.x() / resolution_m)) + 1,
          static_cast<int>(std::ceil(size.y() / resolution_m)) + 1, resolution_m, origin};
}

void add_line(const Point2& from, const Point2& to, const GridGeometry& geometry, std::vector<Cell>& cells) {
  walk_ray(geometry, from, to, [&](Cell cell, double) {
    if (geometry.contains(cell)) cells.push_back(cell);
    return true;
  });
}

/// The floor joined to the start, over cells' sides only: surfaces are closed diagonally.
void flood(OccupancyGrid& grid, Cell start) {
  std::vector<Cell> open;
  const auto reach = [&](Cell cell) {
    if (!grid.geometry().contains(cell) || grid[cell] != CellState::kUnknown) return;
    grid.set(cell, CellState::kFree);
    open.push_back(cell);
  };
  reach(start);
  while (!open.empty()) {
    const Cell cell = open.back();
    open.pop_back();
    reach({cell.column + 1, cell.row});
    reach({cell.column - 1, cell.row});
    reach({cell.column, cell.row + 1});
    reach({cell.column, cell.row - 1});
  }
}

bool is_beside_floor(const OccupancyGrid& grid, Cell cell) {
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      if (grid.at({cell.column + column, cell.row + row}) == CellState::kFree) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<Cell> surface_cells(const Shape& shape, const GridGeometry& geometry) {
  std::vector<Cell> cells;
  for (const Segment& segment : segments_of(shape)) add_line(segment.from, segment.to, geometry, cells);
  if (const auto* circle = std::get_if<Circle>(&shape)) {
    const int chords = 8 + static_cast<int>(2.0 * std::numbers::pi * circle->radius_m / (0.25 * geometry.resolution_m));
    const auto rim = [&](int i) -> Point2 {
      const double angle_rad = 2.0 * std::numbers::pi * i / chords;
      return circle->centre + circle->radius_m * Point2{std::cos(angle_rad), std::sin(angle_rad)};
    };
    for (int i = 0; i < chords; ++i) add_line(rim(i), rim(i + 1), geometry, cells);
  }
  return cells;
}

OccupancyGrid start_map(const World& world, const Point2& robot_start, double resolution_m) {
  return surveyed_map(world, robot_start, map_geometry(world, resolution_m));
}

OccupancyGrid start_map(const Scenario& scenario, double resolution_m) {
  World world = scenario.world;
  int id = world.largest_id();
  for (const DoorParams& door : scenario.doors) {
    const auto leaf = leaf_of(door, door.is_drawn_open ? 1.0 : 0.0);
    if (leaf) world.objects.push_back({++id, ObjectKind::kDoor, Polyline{{leaf->from, leaf->to}}});
  }
  return start_map(world, scenario.robot.map_from_start.position(), resolution_m);
}

OccupancyGrid surveyed_map(const World& world, const Point2& robot_start, const GridGeometry& geometry) {
  OccupancyGrid grid{geometry};
  const auto hides_floor = [](const Object& object) {
    return object.material != Material::kGlass && object.kind != ObjectKind::kDoor;
  };
  const auto draw = [&](bool hiding) {
    for (const Object& object : world.objects) {
      if (!object.is_drawn || hides_floor(object) != hiding) continue;
      for (const Cell cell : surface_cells(object.shape, grid.geometry())) grid.set(cell, CellState::kOccupied);
    }
  };
  draw(true);
  flood(grid, grid.geometry().cell_at(robot_start));
  draw(false);  // the floor behind a pane or a door is known
  OccupancyGrid seen = grid;
  for (std::size_t i = 0; i < grid.geometry().cell_count(); ++i) {
    const Cell cell = grid.geometry().cell_of(i);
    if (grid[cell] == CellState::kOccupied && !is_beside_floor(grid, cell)) seen.set(cell, CellState::kUnknown);
  }
  return seen;
}

}  // namespace deltamap::simulation
