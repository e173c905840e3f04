// SPDX-License-Identifier: Apache-2.0
// New surfaces without gaps: between the ends of neighbouring beams on one straight face there is none, unless beams
// have gone through it, nor is there a cell left out of a line of cells.
#pragma once

#include <functional>
#include <vector>

#include "core/grid_patch.hpp"
#include "mapping/redraw/map_draft.hpp"
#include "mapping/redraw/placed_scan.hpp"
#include "mapping/redraw/ray_counts.hpp"

namespace deltamap::mapping::redraw {

struct ClosedFacesParams {
  double longest_m = 25.0;  ///< beams beyond end on no face
  double face_slant = 3.0;  ///< votes::FaceParams::slant; >= 1
  int free_passes = 3;      ///< so many clear passes make a gap
};

/// The draft with gaps closed where `may_be_added(cell)`, which is nowhere outside `box`.
[[nodiscard]] MapDraft with_closed_faces(MapDraft draft, const RayCounts& counts, const std::vector<PlacedScan>& scans,
                                         const CellBox& box, const std::function<bool(Cell)>& may_be_added,
                                         const ClosedFacesParams& params);

}  // namespace deltamap::mapping::redraw
