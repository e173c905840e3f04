// SPDX-License-Identifier: Apache-2.0
#include "mapping/map_update.hpp"

#include "mapping/map_update_params.hpp"

namespace deltamap::mapping {

MapUpdate map_update(const OccupancyGrid& map, const ScanSet& set, const MapUpdateParams& params) {
  if (set.pose_in_doubt) {
    MapUpdate update;
    update.refusal = Refusal::kPoseInDoubt;
    return update;
  }
  return set.method == MappingMethod::kPaper ? paper_update(map, set, params.paper)
                                             : evidence_update(map, set, params.evidence);
}

}  // namespace deltamap::mapping
