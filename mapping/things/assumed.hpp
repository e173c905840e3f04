// SPDX-License-Identifier: Apache-2.0
// What is taken to be of a body though nobody has seen it: where the sides that were seen lie on one rectangle, its
// other sides and its inside. It belongs to the thing, never to the map that is driven by; a beam that goes through
// ends it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "core/messages.hpp"
#include "mapping/things/outline_fit.hpp"
#include "mapping/things/thing.hpp"

namespace deltamap::mapping::things {

/// Those that were not seen, where two or three that were fix the rectangle: they end on open floor, or a
/// surface of the map lies along those that were not. Who is seen beside a neighbour may go on behind it: then none.
[[nodiscard]] std::array<bool, 4> assumed_sides(const BodyCells& cells, const Outline& outline,
                                                const OccupancyGrid& map);

/// Well within the outline: neither a surface drawn a cell beside nor the error of a pose reaches so far.
[[nodiscard]] bool is_deep_inside(const Outline& outline, const Point2& place);

/// The scan has beams that went through what the outline closes off, more than stray ones.
[[nodiscard]] bool goes_through(const TrackedScan& tracked, const Outline& outline);

/// Cells of the insides and sides of what stands there and is closed, by what is assumed too, that the map does not
/// have occupied: row by row, each once.
[[nodiscard]] std::vector<Cell> assumed_cells(std::span<const Thing> things, const OccupancyGrid& map);

}  // namespace deltamap::mapping::things
