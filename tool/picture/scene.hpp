// SPDX-License-Identifier: Apache-2.0
// Draws a map with what lies on it: what has changed, path, scan, robot; below it a scale bar and a legend.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/grid/occupancy_grid.hpp"
#include "tool/picture/raster.hpp"

namespace deltamap::tool::picture {

struct Scene {
  const OccupancyGrid& map;
  /// Of the same geometry: cells that it has otherwise are coloured, and where they are few, ringed. Null: none.
  const OccupancyGrid* before = nullptr;
  std::optional<Pose2> robot{};  ///< map_from_robot
  std::optional<std::vector<Point2>>
      path{};                       ///< map frame, in order of time; may be empty: the legend has it all the same
  std::vector<Point2> scan_ends{};  ///< map frame
  std::vector<Point2> doubted{};    ///< map frame: places where the map contradicts itself, ringed
  std::string title{};              ///< above the map; empty: none
  std::optional<CellBox> shown{};   ///< nothing: known_part() of the maps
  int cell_pixels = 0;              ///< side of a cell in the picture; 0: as fits a page
};

/// What is known of either map, and a margin around it; the whole map where nothing is. `before` may be null.
[[nodiscard]] CellBox known_part(const OccupancyGrid& map, const OccupancyGrid* before);

/// Throws std::runtime_error where the two maps differ in geometry, or the picture would have more than 64 million
/// pixels.
[[nodiscard]] Raster drawn(const Scene& scene);

/// Left and right, tops at one height.
[[nodiscard]] Raster side_by_side(const Raster& left, const Raster& right);

}  // namespace deltamap::tool::picture
