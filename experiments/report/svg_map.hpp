// SPDX-License-Identifier: Apache-2.0
// Maps as SVG text, one laid over another.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/occupancy_grid.hpp"

namespace deltamap::experiments {

/// Occupied cells in grey, known floor light.
[[nodiscard]] std::string svg_of_map(const OccupancyGrid& map);

/// Where something went, to be drawn over a map.
struct Trajectory {
  std::vector<Point2> points;  ///< map frame, m
  std::string colour;          ///< of CSS
};

/// Two maps of one geometry: floor of the map light, surfaces that both have dark, those of the map alone blue, those
/// of the other alone orange. Trajectories are drawn over them, the last one on top.
[[nodiscard]] std::string svg_of_difference(const OccupancyGrid& map, const OccupancyGrid& other,
                                            std::span<const Trajectory> trajectories = {});

/// The map's occupied cells in grey, known floor light; over it the other's contour in colour, placed by
/// `map_from_local`.
[[nodiscard]] std::string svg_of_merge(const OccupancyGrid& map, const OccupancyGrid& local,
                                       const Pose2& map_from_local);

}  // namespace deltamap::experiments
