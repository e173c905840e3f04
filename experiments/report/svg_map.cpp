// SPDX-License-Identifier: Apache-2.0
#include "experiments/report/svg_map.hpp"

#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>

#include "mapping/merge/overlay_score.hpp"
#include "mapping/registration/transformed_grid.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kTrajectoryEvery_s = 0.5;

std::string number(int value) { return std::to_string(value); }

/// One path of horizontal runs; row 0 is at the bottom.
template <typename IsDrawn>
std::string path_of_runs(const GridGeometry& geometry, const std::string& colour, IsDrawn&& is_drawn) {
  std::string path = "<path fill=\"" + colour + "\" d=\"";
  for (int row = 0; row < geometry.height; ++row) {
    for (int column = 0; column < geometry.width; ++column) {
      const int first = column;
      while (column < geometry.width && is_drawn(Cell{column, row})) ++column;
      if (column == first) continue;
      path += "M" + number(first) + " " + number(geometry.height - 1 - row) + "h" + number(column - first) + "v1h-" +
              number(column - first) + "z";
    }
  }
  return path + "\"/>";
}

/// To a tenth of a cell, and no point twice; as wide as a pen's line whatever the picture's size.
std::string path_of(const Trajectory& trajectory, const GridGeometry& geometry) {
  std::string path = "<path fill=\"none\" stroke=\"" + trajectory.colour +
                     "\" stroke-width=\"1.2\" stroke-linejoin=\"round\" vector-effect=\"non-scaling-stroke\" d=\"";
  std::string last;
  for (const Point2& point : trajectory.points) {
    const Point2 cells = (point - geometry.origin) / geometry.resolution_m;
    std::array<char, 64> at{};
    (void)std::snprintf(at.data(), at.size(), "%.1f %.1f", cells.x(), geometry.height - cells.y());
    if (at.data() == last) continue;
    path += (last.empty() ? "M" : "L") + std::string{at.data()};
    last = at.data();
  }
  return path + "\"/>";
}

std::string opened_svg(const GridGeometry& frame) {
  return "<svg viewBox=\"0 0 " + number(frame.width) + " " + number(frame.height) +
         "\" style=\"max-width:34rem\" shape-rendering=\"crispEdges\">";
}

std::string paths_of_map(const OccupancyGrid& map) {
  return path_of_runs(map.geometry(), "#eeeeee", [&](Cell cell) { return map[cell] == CellState::kFree; }) +
         path_of_runs(map.geometry(), "#888888", [&](Cell cell) { return map[cell] == CellState::kOccupied; });
}

}  // namespace

std::string svg_of_map(const OccupancyGrid& map) { return opened_svg(map.geometry()) + paths_of_map(map) + "</svg>\n"; }

std::string svg_of_difference(const OccupancyGrid& map, const OccupancyGrid& other,
                              std::span<const Trajectory> trajectories) {
  assert(map.geometry() == other.geometry() && "both maps must have the same cells");
  const auto surface = [](bool in_map, bool in_other, const OccupancyGrid& one, const OccupancyGrid& two) {
    return [=, &one, &two](Cell cell) {
      return (one[cell] == CellState::kOccupied) == in_map && (two[cell] == CellState::kOccupied) == in_other;
    };
  };
  std::string svg = opened_svg(map.geometry()) +
                    path_of_runs(map.geometry(), "#eeeeee", [&](Cell cell) { return map[cell] == CellState::kFree; }) +
                    path_of_runs(map.geometry(), "#444444", surface(true, true, map, other)) +
                    path_of_runs(map.geometry(), "#1f5fa8", surface(true, false, map, other)) +
                    path_of_runs(map.geometry(), "#c4531c", surface(false, true, map, other));
  for (const Trajectory& trajectory : trajectories) svg += path_of(trajectory, map.geometry());
  return svg + "</svg>\n";
}

void TrajectoryPair::add(double time_s, const Point2& truth, const Point2& believed) {
  if (time_s < next_s_) return;
  next_s_ = time_s + kTrajectoryEvery_s;
  both_[0].points.push_back(truth);
  both_[1].points.push_back(believed);
}

std::string svg_of_trajectories(const OccupancyGrid& map, const TrajectoryPair& paths) {
  return svg_of_difference(map, map, paths.both());
}

std::string svg_of_merge(const OccupancyGrid& map, const OccupancyGrid& local, const Pose2& map_from_local) {
  // A frame that holds both.
  const OccupancyGrid placed = mapping::registration::moved_grid(local, map_from_local, map.resolution_m());
  const GridGeometry& one = map.geometry();
  const GridGeometry& other = placed.geometry();
  const auto far = [](const GridGeometry& g) { return Point2{g.origin + g.resolution_m * Point2{g.width, g.height}}; };
  const Point2 low = one.origin.cwiseMin(other.origin);
  const Point2 size = (far(one).cwiseMax(far(other)) - low) / one.resolution_m;
  const GridGeometry frame{static_cast<int>(std::ceil(size.x())), static_cast<int>(std::ceil(size.y())),
                           one.resolution_m, low};
  const OccupancyGrid below = mapping::registration::transformed_grid(map, {}, frame);
  OccupancyGrid above{frame};
  for (const Cell& cell : contour_cells(local)) {
    const Cell there = frame.cell_at(map_from_local * local.geometry().centre_of(cell));
    if (frame.contains(there)) above.set(there, CellState::kOccupied);
  }
  return opened_svg(frame) + paths_of_map(below) +
         path_of_runs(frame, "#c4531c", [&](Cell cell) { return above[cell] == CellState::kOccupied; }) + "</svg>\n";
}

}  // namespace deltamap::experiments
