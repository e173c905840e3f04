// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "core/grid/occupancy_grid.hpp"

namespace deltamap::tool {

/// read_grid(), with its notes as warnings on standard error.
[[nodiscard]] OccupancyGrid told_grid(const std::filesystem::path& yaml_file);

}  // namespace deltamap::tool
