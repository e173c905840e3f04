// SPDX-License-Identifier: Apache-2.0
// The last fraction of a cell of a merge: shifts and turns the cells along a local map's edges until free lies on free
// and occupied on occupied, by Gauss–Newton on the map read between its cells (Lucas and Kanade, "An iterative image
// registration technique", 1981). Both sides of an edge count, so that half cells of surface cancel.
#pragma once

#include <span>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "mapping/merge/overlay_score.hpp"

namespace deltamap::surveying::grid_registration {

struct EdgeRegistrationParams {
  int most_iterations = 10;
  double settled_cells = 0.003;        ///< a step below this (at the lever arm, if a turn) ends the iteration; > 0
  double most_correction_cells = 2.0;  ///< farther than this from where it began the answer is not trusted; > 0
};

/// A known cell on or beside the contour, about the local map's middle.
struct EdgeCell {
  mapping::merge::PointInCells at;
  CellState state = CellState::kFree;  ///< never unknown
};
/// Of the local map's contour; its middle in cells from the corner.
[[nodiscard]] std::vector<EdgeCell> edge_cells(const OccupancyGrid& local, std::span<const Cell> contour,
                                               const Point2& middle);
/// The same of the contour of all of it.
[[nodiscard]] std::vector<EdgeCell> edge_cells(const OccupancyGrid& local);

/// Eq. 11 over the cells that come to lie on the map.
[[nodiscard]] mapping::registration::Acceptance edge_acceptance(const OccupancyGrid& map,
                                                                std::span<const EdgeCell> edges,
                                                                const mapping::merge::CellMotion& motion);

/// `start` within about a cell of the answer; `start` itself where the edges do not hold it.
[[nodiscard]] mapping::merge::CellMotion edge_registration(const OccupancyGrid& map, std::span<const EdgeCell> edges,
                                                           const mapping::merge::CellMotion& start,
                                                           const EdgeRegistrationParams& params);

}  // namespace deltamap::surveying::grid_registration
