// SPDX-License-Identifier: Apache-2.0
// What is told of a map's quality: lines for people, JSON, rings on a picture.
#pragma once

#include <string>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "surveying/quality/map_quality.hpp"

namespace deltamap::tool {

/// One line for each limit that is broken, what and where; else one that says what was looked at.
[[nodiscard]] std::vector<std::string> quality_lines(const surveying::quality::MapQuality& quality);

/// An object, as text.
[[nodiscard]] std::string quality_as_json(const surveying::quality::MapQuality& quality);

/// A PNG. Throws std::runtime_error naming the file.
void draw_quality(const OccupancyGrid& map, const surveying::quality::MapQuality& quality, const std::string& png);

}  // namespace deltamap::tool
