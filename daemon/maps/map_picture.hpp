// SPDX-License-Identifier: Apache-2.0
// /api/map.png: a map, one pixel a cell, for whoever wants the cells and nothing else.
#pragma once

#include <string>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::daemon {

/// The bytes of a PNG, without the unknown margin: free white, unknown grey, occupied black; the highest row on top.
/// Throws std::runtime_error where that cannot be drawn.
[[nodiscard]] std::string map_picture(const OccupancyGrid& map);

}  // namespace deltamap::daemon
