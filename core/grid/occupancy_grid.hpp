// SPDX-License-Identifier: Apache-2.0
// The map: a grid of free, occupied and unknown cells, and where it lies. It costs what it shows, not what its
// rectangle holds, and the revisions of a map share what they do not change. Grids travel as shared_ptr<const> and
// never change.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/grid_geometry.hpp"
#include "core/grid/tiled.hpp"

namespace deltamap {

enum class CellState : std::uint8_t { kFree = 0, kOccupied = 1, kUnknown = 2 };

class OccupancyGrid {
 public:
  OccupancyGrid() = default;
  explicit OccupancyGrid(const GridGeometry& geometry, CellState fill = CellState::kUnknown)
      : geometry_{geometry}, fill_{fill}, cells_{geometry.width, geometry.height, fill} {}

  [[nodiscard]] const GridGeometry& geometry() const { return geometry_; }
  [[nodiscard]] int width() const { return geometry_.width; }
  [[nodiscard]] int height() const { return geometry_.height; }
  [[nodiscard]] double resolution_m() const { return geometry_.resolution_m; }
  [[nodiscard]] CellBox box() const { return geometry_.box(); }

  /// The cell must lie in the grid.
  [[nodiscard]] CellState operator[](Cell cell) const { return cells_[cell]; }
  /// Outside the grid everything is unknown.
  [[nodiscard]] CellState at(Cell cell) const { return geometry_.contains(cell) ? cells_[cell] : CellState::kUnknown; }
  void set(Cell cell, CellState state) { cells_.set(cell, state); }

  /// What the grid was filled with, and every cell still is whose tile has not been written to.
  [[nodiscard]] CellState fill() const { return fill_; }
  [[nodiscard]] const Tiled<CellState>& tiles() const { return cells_; }

  friend bool operator==(const OccupancyGrid& a, const OccupancyGrid& b);

 private:
  GridGeometry geometry_;
  CellState fill_ = CellState::kUnknown;
  Tiled<CellState> cells_;
};

/// `visit(Cell, CellState)` for each cell that is free or occupied, row by row from the lowest y.
template <typename Visit>
void for_each_known(const OccupancyGrid& grid, Visit&& visit);

/// The smallest box that holds every free or occupied cell; empty for none.
[[nodiscard]] CellBox known_box(const OccupancyGrid& grid);

[[nodiscard]] std::size_t count_of(const OccupancyGrid& grid, CellState state);

/// A copy of all cells side by side, row by row from the lowest y: as large as the rectangle.
[[nodiscard]] std::vector<CellState> all_cells(const OccupancyGrid& grid);

/// FNV-1a (64 bit) over size, resolution, origin and cells: names a map, so that another map never finds its revisions.
[[nodiscard]] std::uint64_t grid_hash(const OccupancyGrid& grid);

template <typename Visit>
void for_each_known(const OccupancyGrid& grid, Visit&& visit) {
  const auto visit_piece = [&](Cell first, std::span<const CellState> cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells[i] != CellState::kUnknown) visit(Cell{first.column + static_cast<int>(i), first.row}, cells[i]);
    }
  };
  const auto is_wanted = [&](Cell cell) {
    return grid.fill() != CellState::kUnknown || grid.tiles().tile_at(cell) != grid.tiles().background();
  };
  grid.tiles().visit_where(grid.box(), is_wanted, visit_piece);
}

}  // namespace deltamap
