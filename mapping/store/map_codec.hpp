// SPDX-License-Identifier: Apache-2.0
// Grids and changes as bytes for the map store: runs of equal cells, numbers in as few bytes as they need (LEB128).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/grid/grid_patch.hpp"
#include "core/grid/occupancy_grid.hpp"

namespace deltamap::mapping::store {

[[nodiscard]] std::vector<std::uint8_t> encoded_grid(const OccupancyGrid& grid);
/// Nothing where the bytes do not describe a whole grid of that geometry.
[[nodiscard]] std::optional<OccupancyGrid> decoded_grid(std::span<const std::uint8_t> bytes,
                                                        const GridGeometry& geometry);

/// In row order, whatever the order of `changes`.
[[nodiscard]] std::vector<std::uint8_t> encoded_changes(std::span<const CellChange> changes,
                                                        const GridGeometry& geometry);
/// Nothing where the bytes are cut or name cells outside of the geometry.
[[nodiscard]] std::optional<std::vector<CellChange>> decoded_changes(std::span<const std::uint8_t> bytes,
                                                                     const GridGeometry& geometry);

}  // namespace deltamap::mapping::store
