// SPDX-License-Identifier: Apache-2.0
// A merge brought on by what still disagrees: each cell along the edges that lies in a cell of the other state is drawn
// across the border between them, and those that agree by a hair are kept inside (the hinge loss of support vector
// machines, squared). Near the lattice's own turns edges line up with whole rows: read between its cells the map then
// leaves a pose that is half a cell off where it is, and a small step changes nothing.
#pragma once

#include <span>

#include "surveying/grid_registration/edge_registration.hpp"

namespace deltamap::surveying::grid_registration {

struct BorderRegistrationParams {
  int most_iterations = 8;
  double margin_cells = 0.15;   ///< agreeing cells nearer than this to the other state are pushed inwards; [0, 0.5)
  double settled_cells = 0.01;  ///< a step below this (at the lever arm, if a turn) ends the iteration; > 0
};

/// The pose on the way with the best Eq. 11 over the edges; `start`, within half a cell of the answer, among them.
[[nodiscard]] mapping::merge::CellMotion border_registration(const OccupancyGrid& map, std::span<const EdgeCell> edges,
                                                             const mapping::merge::CellMotion& start,
                                                             const BorderRegistrationParams& params);

}  // namespace deltamap::surveying::grid_registration
