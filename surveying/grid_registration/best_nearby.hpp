// SPDX-License-Identifier: Apache-2.0
// The last tenths of a cell of a merge: the best of all poses beside it, by Eq. 11 itself. It has many peaks a few
// hundredths of a cell apart, and ridges that no single axis follows; a search that climbs stays on the nearest.
#pragma once

#include <span>

#include "surveying/grid_registration/edge_registration.hpp"

namespace deltamap::surveying::grid_registration {

struct BestNearbyParams {
  double reach_cells = 0.12;        ///< how far is looked along each axis, a turn at the lever arm; (0, 0.25]
  double shift_step_cells = 0.005;  ///< at least a fiftieth of the reach
  double turn_step_cells = 0.02;    ///< at the lever arm; beside the best ones it is halved twice
};

/// The best pose of a lattice around one, by Eq. 11 over the cells along the edges. So near, a shift along x takes
/// cells across the borders of columns and one along y across those of rows: for each turn, both are found apart, from
/// one look at every cell that may cross. Cells at the rim of the map do not count.
[[nodiscard]] mapping::merge::CellMotion best_nearby(const OccupancyGrid& map, std::span<const EdgeCell> edges,
                                                     const mapping::merge::CellMotion& start,
                                                     const BestNearbyParams& params = {});

}  // namespace deltamap::surveying::grid_registration
