// SPDX-License-Identifier: Apache-2.0
// The rectangle that the cells of a body's surface lie on: the heading at which most of them are on a side, then as
// large as they reach. An L of two faces gives the whole rectangle, a single face a thin one.
#pragma once

#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "mapping/things/thing.hpp"

namespace deltamap::mapping::things {

/// Centres of cells, m, map frame.
struct BodyCells {
  std::vector<Point2> faces;   ///< of the body's surface; at least one where an outline is asked for
  std::vector<Point2> inside;  ///< closed off by it, or floor that became free behind it
  double resolution_m = 0.0;
};

/// Of a body that has come: around all its cells. A side is seen where most of its length is a face.
[[nodiscard]] Outline outline_of_come(const BodyCells& cells);

/// Of a body that has gone. Where only one face of it was known, it is as deep as the floor that became free behind
/// that face. A side is seen where most of what lies beyond it is known in `map`.
[[nodiscard]] Outline outline_of_gone(const BodyCells& cells, const OccupancyGrid& map);

/// What has gone from beside a neighbour or a wall stood against it: its side there was hidden, and the floor that
/// became free ends a cell or two before. The outline with such sides where the surface lies.
[[nodiscard]] Outline up_to_neighbours(const Outline& freed, const OccupancyGrid& map);

/// Share of the surface that lies on the sides of the outline, [0, 1].
[[nodiscard]] double share_on_sides(const BodyCells& cells, const Outline& outline);

}  // namespace deltamap::mapping::things
