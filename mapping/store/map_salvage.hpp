// SPDX-License-Identifier: Apache-2.0
// What can be saved from a map store that is damaged or cannot be written: the newest map that is whole. Only reads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "core/grid/occupancy_grid.hpp"
#include "core/time.hpp"

namespace deltamap::mapping::store {

struct SalvagedMap {
  std::uint32_t number = 0;  ///< k
  Timestamp time;
  OccupancyGrid grid;
};

/// The newest M_k of this M_0 that can be restored bit for bit, k > 0; nothing where there is none.
[[nodiscard]] std::optional<SalvagedMap> newest_whole_map(const std::filesystem::path& store,
                                                          const OccupancyGrid& first);

}  // namespace deltamap::mapping::store
