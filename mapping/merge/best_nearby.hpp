// SPDX-License-Identifier: Apache-2.0
// The last hundredths of a cell of a merge: the best of many poses beside it, by Eq. 11 itself.
#pragma once

#include <span>

#include "mapping/merge/edge_registration.hpp"

namespace deltamap::mapping::merge {

/// Tries neighbours of a pose, by Eq. 11 over the cells along the edges, and moves to what is better: the edges of two
/// lattices do not average out everywhere. Each of `rounds` tries a step along each axis, `step_cells` at first and
/// half as far once none is better; never farther than two of the first along any axis.
[[nodiscard]] CellMotion best_nearby(const OccupancyGrid& map, std::span<const EdgeCell> edges, const CellMotion& start,
                                     double step_cells = 0.06, int rounds = 6);

}  // namespace deltamap::mapping::merge
