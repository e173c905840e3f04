// SPDX-License-Identifier: Apache-2.0
// Messages by Foxglove's published JSON schemas (npm: @foxglove/schemas): what its viewer shows without further ado.
#pragma once

#include <string>
#include <string_view>

#include "core/messages.hpp"

namespace deltamap::tool::foxglove {

/// One of "LaserScan", "PoseInFrame", "Grid", "Log".
[[nodiscard]] std::string schema_of(std::string_view message);

/// The laser's origin in `frame`. 0 where a beam brought no range: JSON has no infinity.
[[nodiscard]] std::string laser_scan(const Scan& scan, std::string_view frame, const Pose2& frame_from_laser);
[[nodiscard]] std::string pose_in_frame(Timestamp time, std::string_view frame, const Pose2& frame_from_robot);
/// A byte a cell, "occupancy": 0 free, 127 unknown, 255 occupied.
[[nodiscard]] std::string grid(Timestamp time, std::string_view frame, const OccupancyGrid& map);

enum class Level { kInfo = 2, kWarning = 3 };
/// `name`: who says it.
[[nodiscard]] std::string log(Timestamp time, Level level, std::string_view name, std::string_view message);

}  // namespace deltamap::tool::foxglove
