// SPDX-License-Identifier: Apache-2.0
// The map S_k that aligned scans draw by themselves (paper §3.3): every beam frees the cells that it crosses and votes
// for the cell that it ends in.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "core/grid/occupancy_grid.hpp"
#include "core/messages.hpp"

namespace deltamap::mapping::alignment {

struct LocalMapParams {
  double longest_m = 12.0;        ///< beyond, neighbouring beams leave cells out; > 0
  double least_hit_share = 0.25;  ///< hits / (hits + crossings) from which a cell is occupied; (0, 1]
  int least_hits = 1;             ///< and at least so many: one alone may be a passer-by; >= 1
};

/// One pose for each scan. The cells are those of `lattice` (its resolution and the phase of its borders), as many as
/// the scans touch. Only valid ranges count.
[[nodiscard]] OccupancyGrid local_map(std::span<const TrackedScan* const> scans, std::span<const Pose2> map_from_robot,
                                      const GridGeometry& lattice, const LocalMapParams& params);

/// The nth scan, until the next one is asked for: they need not all exist at one time.
using ScanSource = std::function<const TrackedScan&(std::size_t)>;
/// The same, of as many scans as there are poses; each is asked for twice.
[[nodiscard]] OccupancyGrid local_map(const ScanSource& scan_at, std::span<const Pose2> map_from_robot,
                                      const GridGeometry& lattice, const LocalMapParams& params);

}  // namespace deltamap::mapping::alignment
