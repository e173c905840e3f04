// SPDX-License-Identifier: Apache-2.0
// Takes a wrong Δ back: what leads from the map of today to one without it, wherever nobody has changed the map since.
#pragma once

#include <span>
#include <vector>

#include "core/grid/grid_patch.hpp"
#include "core/grid/occupancy_grid.hpp"

namespace deltamap::mapping::store {

/// For each cell of `delta` that still holds what the Δ wrote: back to what it was before. To take several Δ back,
/// begin with the newest.
[[nodiscard]] std::vector<CellChange> taken_back(const OccupancyGrid& map, std::span<const CellChange> delta);

}  // namespace deltamap::mapping::store
