// SPDX-License-Identifier: Apache-2.0
// Places to merge maps of: four that are unlike each other, drawn anew for each seed, finer than the maps that are cut
// from them. None looks the same after a turn.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::experiments {

/// The paper's hall (§4, Figure 7): 35 × 35 m, four blocks of 10 × 10 m of containers, some missing; 5 m corridors.
[[nodiscard]] OccupancyGrid drawn_warehouse(std::uint64_t seed);
/// 32 × 20 m: rooms of different widths with doors and furniture on both sides of a corridor, thin walls.
[[nodiscard]] OccupancyGrid drawn_offices(std::uint64_t seed);
/// 40 × 26 m: long racks of different lengths on posts, aisles, pallets.
[[nodiscard]] OccupancyGrid drawn_racks(std::uint64_t seed);
/// About 34 × 28 m: oblique outer walls, machines turned anyhow, round pillars.
[[nodiscard]] OccupancyGrid drawn_workshop(std::uint64_t seed);

struct MergeLayout {
  std::string name;
  OccupancyGrid (*drawn)(std::uint64_t seed);
};
[[nodiscard]] std::vector<MergeLayout> merge_layouts();

}  // namespace deltamap::experiments
