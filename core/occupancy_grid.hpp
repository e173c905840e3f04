// SPDX-License-Identifier: Apache-2.0
// The map: a grid of free, occupied and unknown cells, and where it lies. A cell's value belongs to its area; its
// centre is at +0.5. Row 0 has the lowest y, column 0 the lowest x. Grids travel as shared_ptr<const> and never change.
#pragma once

#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/pose2.hpp"

namespace deltamap {

enum class CellState : std::uint8_t { kFree = 0, kOccupied = 1, kUnknown = 2 };

struct Cell {
  int column = 0;
  int row = 0;
  friend bool operator==(const Cell&, const Cell&) = default;
};

/// No grid has a cell so far away; its neighbours still are whole numbers.
inline constexpr double kFarthestCell = 1e9;

/// As std::floor, at a quarter of its instructions where the processor has none for it. What lies beyond
/// kFarthestCell stays there, and what is no number is taken for the lowest: a cast would be undefined.
[[nodiscard]] inline int rounded_down(double value) {
  const double from_below = value > -kFarthestCell ? value : -kFarthestCell;
  const double within = from_below < kFarthestCell ? from_below : kFarthestCell;
  const int towards_zero = static_cast<int>(within);
  return towards_zero - (within < towards_zero ? 1 : 0);
}

/// Where a grid lies in its map frame: no rotation.
struct GridGeometry {
  int width = 0;              ///< columns
  int height = 0;             ///< rows
  double resolution_m = 0.0;  ///< side of a cell, > 0
  Point2 origin{0.0, 0.0};    ///< lower left corner of cell (0, 0), m, map frame

  [[nodiscard]] bool contains(Cell cell) const {
    return static_cast<unsigned>(cell.column) < static_cast<unsigned>(width) &&
           static_cast<unsigned>(cell.row) < static_cast<unsigned>(height);
  }
  /// The cell whose area holds the point; it may lie outside the grid.
  [[nodiscard]] Cell cell_at(const Point2& point_in_map) const {
    return {rounded_down((point_in_map.x() - origin.x()) / resolution_m),
            rounded_down((point_in_map.y() - origin.y()) / resolution_m)};
  }
  [[nodiscard]] Point2 centre_of(Cell cell) const {
    return {origin.x() + (cell.column + 0.5) * resolution_m, origin.y() + (cell.row + 0.5) * resolution_m};
  }
  [[nodiscard]] std::size_t cell_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  [[nodiscard]] std::size_t index_of(Cell cell) const {
    assert(contains(cell) && "the cell must lie in the grid");
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(cell.column);
  }
  [[nodiscard]] Cell cell_of(std::size_t index) const {
    return {static_cast<int>(index % static_cast<std::size_t>(width)),
            static_cast<int>(index / static_cast<std::size_t>(width))};
  }
  friend bool operator==(const GridGeometry& a, const GridGeometry& b) {
    return a.width == b.width && a.height == b.height && a.resolution_m == b.resolution_m && a.origin == b.origin;
  }
};

class OccupancyGrid {
 public:
  OccupancyGrid() = default;
  explicit OccupancyGrid(const GridGeometry& geometry, CellState fill = CellState::kUnknown)
      : geometry_{geometry}, cells_(geometry.cell_count(), fill) {}

  [[nodiscard]] const GridGeometry& geometry() const { return geometry_; }
  [[nodiscard]] int width() const { return geometry_.width; }
  [[nodiscard]] int height() const { return geometry_.height; }
  [[nodiscard]] double resolution_m() const { return geometry_.resolution_m; }

  [[nodiscard]] CellState operator[](Cell cell) const { return cells_[geometry_.index_of(cell)]; }
  /// Outside the grid everything is unknown.
  [[nodiscard]] CellState at(Cell cell) const {
    return geometry_.contains(cell) ? cells_[geometry_.index_of(cell)] : CellState::kUnknown;
  }
  void set(Cell cell, CellState state) { cells_[geometry_.index_of(cell)] = state; }

  /// Row by row from the lowest y.
  [[nodiscard]] const std::vector<CellState>& cells() const { return cells_; }
  friend bool operator==(const OccupancyGrid&, const OccupancyGrid&) = default;

 private:
  GridGeometry geometry_;
  std::vector<CellState> cells_;
};

[[nodiscard]] std::size_t count_of(const OccupancyGrid& grid, CellState state);

/// FNV-1a (64 bit) over size, resolution, origin and cells: names a map, so that another map never finds its revisions.
[[nodiscard]] std::uint64_t grid_hash(const OccupancyGrid& grid);

}  // namespace deltamap
