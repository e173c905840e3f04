// SPDX-License-Identifier: Apache-2.0
#include "mapping/bays/line_of_cells.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::mapping::bays {
namespace {

constexpr double kAlong = 1e-9;  // of a unit vector: so much across is none

/// Of the line within the layout.
struct Stretch {
  double enters_m = 0.0;
  double leaves_m = -HUGE_VAL;
};

Stretch stretch_in(const CellLayout& layout, const Point2& from, const Point2& direction) {
  const std::array<double, 2> size{layout.columns * layout.edge_m, layout.rows * layout.edge_m};
  Stretch stretch{0.0, HUGE_VAL};
  for (int axis = 0; axis < 2; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (std::abs(direction[axis]) < kAlong) {
      if (from[axis] < 0.0 || from[axis] >= size[a]) return {};
      continue;
    }
    const double low_m = -from[axis] / direction[axis];
    const double high_m = (size[a] - from[axis]) / direction[axis];
    stretch.enters_m = std::max(stretch.enters_m, std::min(low_m, high_m));
    stretch.leaves_m = std::min(stretch.leaves_m, std::max(low_m, high_m));
  }
  return stretch;
}

}  // namespace

LineOfCells cells_on_line(const CellLayout& layout, const Point2& from, const Point2& direction, double within_m) {
  LineOfCells line;
  const auto [enters_m, leaves_m] = stretch_in(layout, from, direction);
  if (enters_m >= leaves_m || enters_m > within_m) return line;
  const Point2 begin = from + enters_m * direction;
  int column = std::clamp(static_cast<int>(begin.x() / layout.edge_m), 0, layout.columns - 1);
  int row = std::clamp(static_cast<int>(begin.y() / layout.edge_m), 0, layout.rows - 1);
  const int step_column = direction.x() > 0.0 ? 1 : -1;
  const int step_row = direction.y() > 0.0 ? 1 : -1;
  const auto border_m = [&](int index, int step, int axis) {
    if (std::abs(direction[axis]) < kAlong) return HUGE_VAL;
    return ((index + (step > 0 ? 1 : 0)) * layout.edge_m - from[axis]) / direction[axis];
  };
  double next_column_m = border_m(column, step_column, 0);
  double next_row_m = border_m(row, step_row, 1);
  double at_m = enters_m;
  while (column >= 0 && column < layout.columns && row >= 0 && row < layout.rows &&
         line.count < static_cast<int>(line.steps.size())) {
    const double to_m = std::min({next_column_m, next_row_m, leaves_m});
    line.steps[static_cast<std::size_t>(line.count++)] = {row * layout.columns + column, at_m, to_m};
    at_m = to_m;
    if (next_column_m < next_row_m) {
      column += step_column;
      next_column_m += layout.edge_m / std::abs(direction.x());
    } else {
      row += step_row;
      next_row_m += layout.edge_m / std::abs(direction.y());
    }
  }
  return line;
}

}  // namespace deltamap::mapping::bays
