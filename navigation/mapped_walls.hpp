// SPDX-License-Identifier: Apache-2.0
// What the map has where the laser brings nothing back: a beam without a range does not free what stands in its way.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/messages.hpp"

namespace deltamap::navigation {

/// Of beams that lie two degrees apart: enough to see a wall by, fewer to look up.
[[nodiscard]] std::size_t beams_between(const Scan& scan);

/// How far along this beam the map has a wall that the laser should see; nothing where it has none, or the map is null.
[[nodiscard]] std::optional<double> mapped_wall_m(const TrackedScan& tracked, std::size_t beam);

/// Where beams without a range would meet an occupied cell of the map within `within_m`, in the robot's frame at
/// Scan::time; none while the pose is not tracked.
[[nodiscard]] std::vector<Point2> walls_behind_lost_beams(const TrackedScan& tracked, double within_m);

/// In the directions of the beams without a range the map knows the floor, and nothing on it that the laser could
/// reach: they are what they should be. False where the map does not know, or the pose is not tracked.
[[nodiscard]] bool expects_no_range(const TrackedScan& tracked);

}  // namespace deltamap::navigation
