// SPDX-License-Identifier: Apache-2.0
// Reads M_0 for a start, and says by file name what is wrong with it: larger than the memory, coarse, without floor.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/occupancy_grid.hpp"
#include "daemon/memory_limit.hpp"

namespace deltamap::daemon {

struct FirstMap {
  OccupancyGrid grid;
  std::vector<std::string> warnings;  ///< one line each, that begins with the file
};

/// Throws std::runtime_error with one line that names the file: as read_grid() does, where the map needs more memory
/// than there may be (before its pixels are kept, with both figures), or where it has no free cell.
[[nodiscard]] FirstMap read_first_map(const std::filesystem::path& file, const MemoryLimit& limit);

}  // namespace deltamap::daemon
