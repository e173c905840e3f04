// SPDX-License-Identifier: Apache-2.0
// A change of a map: which cells took which state, and rectangles of cells.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/occupancy_grid.hpp"

namespace deltamap {

/// A rectangle of cells: first included, last excluded. Empty where last <= first.
struct CellBox {
  Cell first;
  Cell last;

  [[nodiscard]] int width() const { return last.column - first.column; }
  [[nodiscard]] int height() const { return last.row - first.row; }
  [[nodiscard]] bool empty() const { return width() <= 0 || height() <= 0; }
  [[nodiscard]] bool contains(Cell cell) const {
    return cell.column >= first.column && cell.row >= first.row && cell.column < last.column && cell.row < last.row;
  }
  friend bool operator==(const CellBox&, const CellBox&) = default;
};

/// The box grown by `cells` on every side and clipped to the grid.
[[nodiscard]] CellBox grown(const CellBox& box, int cells, const GridGeometry& geometry);

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
