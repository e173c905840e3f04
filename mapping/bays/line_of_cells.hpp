// SPDX-License-Identifier: Apache-2.0
// The cells of a bay's floor that a beam's line passes, in its direction.
#pragma once

#include <array>
#include <cstddef>

#include "core/geometry/pose2.hpp"

namespace deltamap::mapping::bays {

inline constexpr int kMostCellsAlong = 24;

/// Square cells, row by row from the lower left corner, which is the origin.
struct CellLayout {
  double edge_m = 0.0;  ///< of a cell, > 0
  int columns = 0;      ///< in [1, kMostCellsAlong]
  int rows = 0;         ///< in [1, kMostCellsAlong]

  [[nodiscard]] int cells() const { return columns * rows; }
};

/// With the distance at which the line enters and leaves each.
struct LineOfCells {
  struct Step {
    int cell = 0;
    double from_m = 0.0;
    double to_m = 0.0;
  };
  std::array<Step, 2 * kMostCellsAlong + 2> steps;
  int count = 0;  ///< of the steps

  [[nodiscard]] const Step& operator[](int step) const { return steps[static_cast<std::size_t>(step)]; }
};

/// From a point along a unit vector, both in the layout's frame. None where the line passes the cells by, or enters
/// them farther away than within_m.
[[nodiscard]] LineOfCells cells_on_line(const CellLayout& layout, const Point2& from, const Point2& direction,
                                        double within_m);

}  // namespace deltamap::mapping::bays
