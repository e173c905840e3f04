// SPDX-License-Identifier: Apache-2.0
// A body that is pushed by less than its own depth shares floor with its old self: a strip comes on one side of it, one
// goes on the other, and what lies between has not changed. Neither strip is a body; their distance tells the depth.
#pragma once

#include <optional>

#include "core/grid/occupancy_grid.hpp"
#include "mapping/things/thing.hpp"

namespace deltamap::mapping::things {

struct Pushed {
  Outline from;
  Outline at;
};

/// Of a strip that has come and one that has gone: parallel, as deep as each other, the shorter one beside the longer
/// as far as it was seen, and no floor between them. Nothing: they are no two sides of one body.
[[nodiscard]] std::optional<Pushed> pushed_body(const Outline& came, const Outline& gone, const OccupancyGrid& map);

/// Where it stands now, of a body as it stood whose front has gone: behind it, by less than a push, a surface lies
/// across all of its width, the floor before that is free and what lies behind is not. Nothing: it is not there.
[[nodiscard]] std::optional<Outline> pushed_back(const Outline& stood, const OccupancyGrid& map);

}  // namespace deltamap::mapping::things
