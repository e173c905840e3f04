// SPDX-License-Identifier: Apache-2.0
// Boxes of map cells as the live page receives them (docs/api.md).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::daemon::dashboard {

inline constexpr int kBoxSide = 256;  ///< cells: a message holds no longer box

/// The box in pieces of at most kBoxSide cells a side, cut at multiples of it.
[[nodiscard]] std::vector<CellBox> pieces_of(const CellBox& box);

/// Kind 1: 'revision', the box, and its cells row by row from the lowest y, in runs. The box lies in the grid.
[[nodiscard]] std::string cells_message(const OccupancyGrid& grid, const CellBox& box, std::uint32_t revision);

}  // namespace deltamap::daemon::dashboard
