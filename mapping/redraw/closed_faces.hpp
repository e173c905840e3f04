// SPDX-License-Identifier: Apache-2.0
// Closes gaps in new surfaces: cells between the ends of neighbouring beams on one straight face become occupied,
// unless beams have gone through them, and so does a single cell left out of a line.
#pragma once

#include <functional>
#include <vector>

#include "core/grid/grid_patch.hpp"
#include "mapping/redraw/map_draft.hpp"
#include "mapping/redraw/placed_scan.hpp"
#include "mapping/redraw/ray_counts.hpp"

namespace deltamap::mapping::redraw {

struct ClosedFacesParams {
  double longest_m;  ///< beams beyond end on no face
  int free_passes;   ///< so many clear passes make a gap
};

/// The draft with gaps closed where `may_be_added(cell)`, which is nowhere outside `box`.
[[nodiscard]] MapDraft with_closed_faces(MapDraft draft, const RayCounts& counts, const std::vector<PlacedScan>& scans,
                                         const CellBox& box, const std::function<bool(Cell)>& may_be_added,
                                         const ClosedFacesParams& params);

}  // namespace deltamap::mapping::redraw
