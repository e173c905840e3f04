// SPDX-License-Identifier: Apache-2.0
// Transient obstacles: what differs from the map now, and is not, or not yet, written to it. A snapshot that
// Δ-awareness makes for localizer and pilot, long before any MapRevision; travels as shared_ptr<const> and never
// changes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "core/time.hpp"

namespace deltamap {

struct TransientObstacles {
  std::uint32_t number = 0;             ///< counts the snapshots of a run from 1
  Timestamp time;                       ///< of the scan that made it
  GridGeometry blocks;                  ///< squares of cells: they lie on the map like cells of a coarser grid
  std::vector<std::uint32_t> standing;  ///< blocks in which something stands where M_k has nothing; indices, ascending
  std::vector<std::uint32_t> gone;      ///< blocks in which what M_k has was seen gone; indices, ascending

  [[nodiscard]] bool empty() const { return standing.empty() && gone.empty(); }
  [[nodiscard]] bool stands_at(const Point2& point_in_map) const {
    const Cell block = blocks.cell_at(point_in_map);
    if (standing.empty() || !blocks.contains(block)) return false;
    return std::binary_search(standing.begin(), standing.end(), static_cast<std::uint32_t>(blocks.index_of(block)));
  }
};

}  // namespace deltamap
