// SPDX-License-Identifier: Apache-2.0
// Maps as SVG text, one laid over another.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::experiments {

/// Occupied cells in grey, known floor light.
[[nodiscard]] std::string svg_of_map(const OccupancyGrid& map);

/// Where something went, to be drawn over a map.
struct Trajectory {
  std::vector<Point2> points;  ///< map frame, m
  std::string colour;          ///< of CSS
};

/// Where a robot was and where it was believed to be, twice a second.
class TrajectoryPair {
 public:
  void add(double time_s, const Point2& truth, const Point2& believed);
  [[nodiscard]] std::span<const Trajectory> both() const { return both_; }

 private:
  std::array<Trajectory, 2> both_{Trajectory{{}, "#0b7a75"}, Trajectory{{}, "#a3218e"}};
  double next_s_ = 0.0;
};

/// The map with both drawn over it, the believed one on top.
[[nodiscard]] std::string svg_of_trajectories(const OccupancyGrid& map, const TrajectoryPair& paths);

/// Two maps of one geometry: floor of the map light, surfaces that both have dark, those of the map alone blue, those
/// of the other alone orange. Trajectories are drawn over them, the last one on top.
[[nodiscard]] std::string svg_of_difference(const OccupancyGrid& map, const OccupancyGrid& other,
                                            std::span<const Trajectory> trajectories = {});

/// The map's occupied cells in grey, known floor light; over it the other's contour in colour, placed by
/// `map_from_local`.
[[nodiscard]] std::string svg_of_merge(const OccupancyGrid& map, const OccupancyGrid& local,
                                       const Pose2& map_from_local);

}  // namespace deltamap::experiments
