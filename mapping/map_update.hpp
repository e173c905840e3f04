// SPDX-License-Identifier: Apache-2.0
// Front door 2 of mapping: (M_{k-1}, S(k)) → M_k, or the reason for refusal. One pure function.
#pragma once

#include "core/grid/occupancy_grid.hpp"
#include "core/messages.hpp"
#include "mapping/scan_set/map_change.hpp"

namespace deltamap::mapping {

struct MapUpdateParams;

/// The method is the set's own.
[[nodiscard]] scan_set::MapUpdate map_update(const OccupancyGrid& map, const ScanSet& set,
                                             const MapUpdateParams& params);

}  // namespace deltamap::mapping
