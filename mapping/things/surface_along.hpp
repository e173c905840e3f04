// SPDX-License-Identifier: Apache-2.0
// How much of a line in the map lies at a surface: the side of a body that stands there does.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/grid/near_occupied.hpp"

namespace deltamap::mapping::things {

/// Places along a line, a cell apart, with a surface at most one cell away, and all of them (at least one).
struct SurfaceAlong {
  int places = 0;
  int all = 0;
};

/// From one end to the other, in the map frame, m; the places are the middles of equal pieces.
[[nodiscard]] inline SurfaceAlong surface_along(const OccupancyGrid& map, const Point2& from, const Point2& to) {
  SurfaceAlong along{.all = std::max(1, static_cast<int>((to - from).norm() / map.resolution_m()))};
  for (int i = 0; i < along.all; ++i) {
    const Cell cell = map.geometry().cell_at(from + (to - from) * ((i + 0.5) / along.all));
    along.places += has_occupied_within(map, cell, 1) ? 1 : 0;
  }
  return along;
}

}  // namespace deltamap::mapping::things
