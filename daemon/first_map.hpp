// SPDX-License-Identifier: Apache-2.0
// Reads M_0 for a start, and says by file name what is wrong with it: larger than the memory, coarse, without floor.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/system/memory_limit.hpp"
#include "daemon/system/unit_memory.hpp"

namespace deltamap::daemon {

/// The map does not fit into what is free on the machine now.
struct MemoryShortage : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct FirstMap {
  OccupancyGrid grid;
  std::vector<std::string> warnings;  ///< one line each, that begins with the file
};

/// As little as a start and a reload need of the settings: an empty file, or one cut short, is no settings file. Throws
/// SettingsError where they name no map, or one that is not there; `file` is that of the settings.
void require_map_named(const Settings& settings, const std::string& file);

/// Throws std::runtime_error with one line that names the file: as read_grid() does, where the map needs more memory
/// than there may be (before its pixels are kept, with both figures; MemoryShortage where it may fit another time), or
/// where it has no free cell.
[[nodiscard]] FirstMap read_first_map(const std::filesystem::path& file, const MemoryLimit& limit);

/// Empty, or one line that names the file, where a run on that map does not fit into the service. Reads the picture row
/// by row; throws as read_grid() does.
[[nodiscard]] std::string why_not_as_service(const std::filesystem::path& file, const UnitMemory& unit);

/// What a run on that map needs and what there may be: "about 27 MB of 128 MB (MemoryMax of /x), slow from 96 MB
/// (MemoryHigh of /x)". Reads the picture row by row; throws as read_grid() does.
[[nodiscard]] std::string memory_text(const std::filesystem::path& file, const MemoryLimit& limit);

}  // namespace deltamap::daemon
