// SPDX-License-Identifier: Apache-2.0
// A change of a map: which cells took which state, and rectangles of cells.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap {

struct CellChange {
  Cell cell;
  CellState before = CellState::kUnknown;
  CellState after = CellState::kUnknown;
  friend bool operator==(const CellChange&, const CellChange&) = default;
};

/// The smallest box that holds every change; empty for none.
[[nodiscard]] CellBox bounding_box(std::span<const CellChange> changes);

/// The grid with every change applied (only `after` counts).
[[nodiscard]] OccupancyGrid patched(OccupancyGrid grid, std::span<const CellChange> changes);

/// What leads from one grid to another of the same geometry, in row order.
[[nodiscard]] std::vector<CellChange> changes_between(const OccupancyGrid& before, const OccupancyGrid& after);

/// A rectangle of bytes that replaces the same rectangle of the localizer's field, row by row.
struct FieldPatch {
  CellBox box;
  std::vector<std::uint8_t> values;
};

}  // namespace deltamap
