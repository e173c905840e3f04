// SPDX-License-Identifier: Apache-2.0
#include "mapping/map_update.hpp"

#include "mapping/map_update_params.hpp"

namespace deltamap::mapping {

scan_set::MapUpdate map_update(const OccupancyGrid& map, const ScanSet& set, const MapUpdateParams& params) {
  if (set.pose_in_doubt) {
    scan_set::MapUpdate update;
    update.refusal = scan_set::Refusal::kPoseInDoubt;
    return update;
  }
  return set.method == MappingMethod::kPaper ? paper::paper_update(map, set, params.paper)
                                             : redraw::evidence_update(map, set, params.evidence);
}

}  // namespace deltamap::mapping
