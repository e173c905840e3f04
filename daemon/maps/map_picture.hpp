// SPDX-License-Identifier: Apache-2.0
// Draws a map, and what has changed in it, as a PNG: what the README and the end of a demo show, and /api/map.png.
#pragma once

#include <filesystem>
#include <string>

#include "core/occupancy_grid.hpp"

namespace deltamap::daemon {

struct MapPictureStyle {
  int cell_pixels = 1;        ///< side of a cell in the picture, >= 1
  bool crop_to_known = true;  ///< leave out the unknown margin
};

/// The bytes of a PNG of `after`: free white, unknown grey, occupied black; cells that `before` had otherwise are
/// coloured: newly occupied red, newly free green, forgotten blue. Both maps have one geometry. Throws
/// std::runtime_error where that cannot be drawn.
[[nodiscard]] std::string map_picture(const OccupancyGrid& before, const OccupancyGrid& after,
                                      const MapPictureStyle& style = {});

/// Writes map_picture() into a file. Throws std::runtime_error naming the file.
void write_map_picture(const OccupancyGrid& before, const OccupancyGrid& after, const std::filesystem::path& png_file,
                       const MapPictureStyle& style = {});

}  // namespace deltamap::daemon
