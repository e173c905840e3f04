// SPDX-License-Identifier: Apache-2.0
// What the log of a run begins with: which program, settings, map and store, which ports, and whether it may drive.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/grid/occupancy_grid.hpp"
#include "daemon/settings/settings.hpp"

namespace deltamap::daemon {

/// One line each. `revision` is the newest of the store; nothing where no store is kept.
[[nodiscard]] std::vector<std::string> start_banner(const Settings& settings, const std::string& config,
                                                    const GridGeometry& map, std::optional<std::uint32_t> revision);

/// "640 x 480 cells of 0.05 m"
[[nodiscard]] std::string size_text(const GridGeometry& map);

}  // namespace deltamap::daemon
