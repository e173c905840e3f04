// SPDX-License-Identifier: Apache-2.0
// The way of a beam over the cells of a box, cell by cell, by their index in the box: the cells of walk_ray in its
// order, for callers to whom every instruction a cell counts.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>

#include "core/grid_patch.hpp"
#include "core/occupancy_grid.hpp"

namespace deltamap {

class BoxWalk {
 public:
  /// Begins in the cell of `from`, which must lie in the box. Inlined, or the walk would not stay in registers.
  [[gnu::always_inline]] BoxWalk(const GridGeometry& map, const CellBox& box, const Point2& from, const Point2& to) {
    const Cell first = map.cell_at(from);
    const Cell last = map.cell_at(to);
    const std::ptrdiff_t width = box.width();
    index_ = (first.row - box.first.row) * width + (first.column - box.first.column);
    width_ = width;
    cells_left_ = std::abs(last.column - first.column) + std::abs(last.row - first.row);
    const double length_m = (to - from).norm();
    const double r = map.resolution_m;
    columns_ = Axis{{.start_m = from.x(), .delta_m = to.x() - from.x(), .length_m = length_m, .cell_m = r},
                    map.origin.x() + first.column * r,
                    {.first = box.first.column, .last = box.last.column, .from = first.column, .to = last.column},
                    1};
    rows_ = Axis{{.start_m = from.y(), .delta_m = to.y() - from.y(), .length_m = length_m, .cell_m = r},
                 map.origin.y() + first.row * r,
                 {.first = box.first.row, .last = box.last.row, .from = first.row, .to = last.row},
                 width};
    // A cell that is entered two cells before the end is not the last one, and the next is not either.
    if (!columns_.leaves && !rows_.leaves) far_from_end_m_ = length_m - 2.0 * r;
  }

  /// In the cell of `to`?
  [[nodiscard]] bool is_at_end() const { return cells_left_ == 0; }
  /// Of the present cell, row by row.
  [[nodiscard]] std::size_t index() const { return static_cast<std::size_t>(index_); }
  /// Distance from `from` at which the beam has entered the present cell.
  [[nodiscard]] double entered_m() const { return entered_m_; }
  /// Goes on while `takes(index)`, through the cells that are entered before `until_m`; stops early near the beam's
  /// end. Far from it no axis runs out of borders: nothing needs counting on the way.
  template <typename Takes>
  [[gnu::always_inline]] void strides(double until_m, Takes&& takes) {
    const double limit_m = std::min(until_m, far_from_end_m_);
    if (entered_m_ >= limit_m) return;
    const double column_m = columns_.per_cell_m;
    const double row_m = rows_.per_cell_m;
    const std::ptrdiff_t column_stride = columns_.stride;
    const std::ptrdiff_t row_stride = rows_.stride;
    double next_column_m = columns_.next_m;
    double next_row_m = rows_.next_m;
    double entered_m = entered_m_;
    std::ptrdiff_t index = index_;
    while (entered_m < limit_m && takes(static_cast<std::size_t>(index))) {
      if (next_column_m < next_row_m) {
        entered_m = next_column_m;
        next_column_m += column_m;
        index += column_stride;
      } else {
        entered_m = next_row_m;
        next_row_m += row_m;
        index += row_stride;
      }
    }
    const int columns = static_cast<int>(std::abs(index % width_ - index_ % width_));
    const int rows = static_cast<int>(std::abs(index / width_ - index_ / width_));
    columns_.has_crossed(columns, next_column_m);
    rows_.has_crossed(rows, next_row_m);
    cells_left_ -= columns + rows;
    entered_m_ = entered_m;
    index_ = index;
  }
  /// On to the next cell, where there is one; false where the beam leaves the box.
  bool goes_on() {
    --cells_left_;
    return columns_.next_m < rows_.next_m ? crosses(columns_) : crosses(rows_);
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  struct Line {
    double start_m, delta_m, length_m, cell_m;
  };
  struct Span {
    int first, last;  // of the box; last excluded
    int from, to;     // of the beam
  };
  struct Axis {
    double next_m = kNever;      // distance at which the beam crosses the next border
    double per_cell_m = kNever;  // distance between borders
    std::ptrdiff_t stride = 0;   // of the index
    int borders_left = 0;        // up to the beam's last cell or the box's, whichever comes first
    bool leaves = false;         // the box's comes first

    Axis() = default;
    Axis(const Line& line, double cell_low_m, const Span& span, std::ptrdiff_t cell_stride) {
      if (span.from == span.to) return;
      const bool ascends = line.delta_m > 0.0;
      const double per_metre = line.delta_m / line.length_m;
      next_m = ((ascends ? cell_low_m + line.cell_m : cell_low_m) - line.start_m) / per_metre;
      per_cell_m = line.cell_m / std::abs(per_metre);
      stride = ascends ? cell_stride : -cell_stride;
      const int to_end = std::abs(span.to - span.from);
      const int in_box = ascends ? span.last - 1 - span.from : span.from - span.first;
      borders_left = std::min(to_end, in_box);
      leaves = in_box < to_end;
    }

    void has_crossed(int borders, double new_next_m) {
      borders_left -= borders;
      next_m = borders_left > 0 ? new_next_m : kNever;
    }
  };

  bool crosses(Axis& axis) {
    if (axis.borders_left == 0) return false;
    index_ += axis.stride;
    entered_m_ = axis.next_m;
    // Counting borders ends the walk exactly in the last cell, whatever the rounding.
    axis.next_m = --axis.borders_left > 0 || axis.leaves ? axis.next_m + axis.per_cell_m : kNever;
    return true;
  }

  Axis columns_;
  Axis rows_;
  std::ptrdiff_t width_ = 1;
  std::ptrdiff_t index_ = 0;
  int cells_left_ = 0;
  double far_from_end_m_ = -kNever;
  double entered_m_ = 0.0;
};

}  // namespace deltamap
