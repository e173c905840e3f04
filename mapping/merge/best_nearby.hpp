// SPDX-License-Identifier: Apache-2.0
// The last hundredths of a cell of a merge: the best of many poses beside it, by Eq. 11 itself.
#pragma once

#include <span>

#include "mapping/merge/edge_registration.hpp"

namespace deltamap::mapping::merge {

/// Tries neighbours of a pose, by Eq. 11 over the cells along the edges, and takes what is better: the edges of two
/// lattices do not average out everywhere. `rounds` of 6 neighbours, `step_cells` away at first; never
/// farther than two steps along any axis.
[[nodiscard]] CellMotion best_nearby(const OccupancyGrid& map, std::span<const EdgeCell> edges, const CellMotion& start,
                                     double step_cells = 0.06, int rounds = 6);

}  // namespace deltamap::mapping::merge
