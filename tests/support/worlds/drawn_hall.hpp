// SPDX-License-Identifier: Apache-2.0
// A hall drawn by rectangles, unlike itself under every turn: walls, containers and a niche.
#pragma once

#include <cmath>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/grid/occupancy_grid.hpp"

namespace deltamap::test {

/// Fills the cells whose centre lies in [low, high).
inline void fill(OccupancyGrid& grid, Point2 low, Point2 high, CellState state) {
  for (int row = 0; row < grid.height(); ++row) {
    for (int column = 0; column < grid.width(); ++column) {
      const Point2 centre = grid.geometry().centre_of({column, row});
      if ((centre.array() >= low.array()).all() && (centre.array() < high.array()).all())
        grid.set({column, row}, state);
    }
  }
}

/// 20 × 14 m inside walls one cell thick, six containers; 0.1 m cells unless told otherwise.
inline OccupancyGrid drawn_hall(double resolution_m = 0.1) {
  const GridGeometry geometry{static_cast<int>(std::lround(22.0 / resolution_m)),
                              static_cast<int>(std::lround(16.0 / resolution_m)),
                              resolution_m,
                              {-1.0, -1.0}};
  OccupancyGrid hall{geometry};
  const double wall = resolution_m;
  fill(hall, {-wall, -wall}, {20.0 + wall, 14.0 + wall}, CellState::kOccupied);
  fill(hall, {0.0, 0.0}, {20.0, 14.0}, CellState::kFree);
  fill(hall, {3.0, 3.0}, {6.0, 5.5}, CellState::kOccupied);
  fill(hall, {9.0, 2.0}, {10.2, 4.4}, CellState::kOccupied);
  fill(hall, {14.0, 4.0}, {17.5, 5.2}, CellState::kOccupied);
  fill(hall, {2.0, 9.0}, {3.2, 12.0}, CellState::kOccupied);
  fill(hall, {8.0, 8.5}, {11.0, 10.0}, CellState::kOccupied);
  fill(hall, {15.0, 9.0}, {16.2, 11.4}, CellState::kOccupied);
  fill(hall, {20.0, 10.0}, {20.8, 12.0}, CellState::kOccupied);
  fill(hall, {20.0 - wall, 10.3}, {20.6, 11.7}, CellState::kFree);
  return hall;
}

/// Where a robot is after so long that drives to and fro below the containers, 5 m each way; it turns at once.
inline Pose2 below_the_containers(double time_s, double speed_m_per_s = 0.4) {
  const double way_m = std::fmod(time_s * speed_m_per_s, 10.0);
  return {way_m < 5.0 ? 7.5 + way_m : 17.5 - way_m, 6.8, way_m < 5.0 ? 0.4 : 2.7};
}

}  // namespace deltamap::test
