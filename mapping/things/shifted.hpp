// SPDX-License-Identifier: Apache-2.0
// A body that is shifted by less than its size stands on part of the floor where it stood: of what it was, only what it
// does not hide is seen to go. Where one of both ends is known as a whole it tells the size of the other.
#pragma once

#include <optional>
#include <span>

#include "core/grid/occupancy_grid.hpp"
#include "mapping/things/pushed.hpp"

namespace deltamap::mapping::things {

/// What was seen of one end of a shift.
struct ShiftEnd {
  Outline outline;
  bool is_whole = false;  ///< its size is known
};

/// Both rectangles, where those of one size fit: what is to be added to either end lies on no floor that is seen free,
/// they share floor, and none of the places `freed` by what has gone lies where the other stands. Nothing: none fit.
[[nodiscard]] std::optional<Pushed> shifted_body(const ShiftEnd& came, const ShiftEnd& gone,
                                                 std::span<const Point2> freed, const OccupancyGrid& map);

}  // namespace deltamap::mapping::things
