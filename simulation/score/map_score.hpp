// SPDX-License-Identifier: Apache-2.0
// How near a map comes to the truth. The acceptance index (paper Eq. 11) alone hides failures, so that the contour is
// counted too: cells of both maps paired one to one, equal cells first, then neighbours.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::simulation::score {

/// One flag a cell of the map's geometry.
using CellMask = std::vector<std::uint8_t>;

struct MapScore {
  double contour_f1 = 0.0;  ///< of the occupied cells, 1 cell of tolerance, each used once; what a slanting surface
                            ///< only clips need not be drawn; [0, 1]
  double acceptance = 0.0;  ///< Eq. 11 where both know; [0, 1]
  double wrong_m2 = 0.0;    ///< the truth is known, the map says the opposite, and no pair explains it
};

/// Over the cells of `where`. All three of one geometry.
[[nodiscard]] MapScore map_score(const OccupancyGrid& truth, const OccupancyGrid& map, const CellMask& where);

/// What of the way from `stale` to `perfect` has been gone: 0 as if never updated, 1 as good as can be; NaN where there
/// is no way.
[[nodiscard]] double skill(double ours, double stale, double perfect);

/// Share of the cells of `these` that are occupied in `first` and have an occupied cell of their own on or beside them
/// in `map`; NaN where there are none.
[[nodiscard]] double share_kept(const OccupancyGrid& first, const OccupancyGrid& map, const CellMask& these);

/// The mask grown by one cell on every side.
[[nodiscard]] CellMask grown(const CellMask& mask, const GridGeometry& geometry);

}  // namespace deltamap::simulation::score
