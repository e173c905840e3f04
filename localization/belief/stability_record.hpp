// SPDX-License-Identifier: Apache-2.0
// What is known of the map's tiles (stability.hpp), as it is kept across restarts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::localization::belief {

struct StabilityRecord {
  static constexpr std::size_t kBytesATile = 4;
  GridGeometry geometry;  ///< of the map
  int cells_a_tile = 0;
  std::vector<std::uint8_t> bytes;  ///< row by row
};

}  // namespace deltamap::localization::belief
