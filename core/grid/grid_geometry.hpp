// SPDX-License-Identifier: Apache-2.0
// Cells, boxes of cells, and where a grid lies in its map frame. A cell's value belongs to its area; its centre is at
// +0.5. Row 0 has the lowest y, column 0 the lowest x.
#pragma once

#include <cassert>
#include <cmath>
#include <cstddef>

#include "core/geometry/pose2.hpp"

namespace deltamap {

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
  [[nodiscard]] std::size_t cell_count() const {
    return empty() ? 0 : static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
  }
  /// Row by row.
  [[nodiscard]] std::size_t index_of(Cell cell) const {
    assert(contains(cell) && "the cell must lie in the box");
    return static_cast<std::size_t>(cell.row - first.row) * static_cast<std::size_t>(width()) +
           static_cast<std::size_t>(cell.column - first.column);
  }
  friend bool operator==(const CellBox&, const CellBox&) = default;
};

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
  /// All cells.
  [[nodiscard]] CellBox box() const { return {{0, 0}, {width, height}}; }
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

/// The smallest box that holds both; an empty one adds nothing.
[[nodiscard]] CellBox united(const CellBox& a, const CellBox& b);

/// What lies in both boxes.
[[nodiscard]] CellBox common(const CellBox& a, const CellBox& b);

/// The box grown by `cells` on every side, wherever that leads; an empty one stays empty.
[[nodiscard]] CellBox grown(const CellBox& box, int cells);
/// The same, clipped to the grid.
[[nodiscard]] CellBox grown(const CellBox& box, int cells, const GridGeometry& geometry);

}  // namespace deltamap
