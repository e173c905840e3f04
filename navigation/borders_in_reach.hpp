// SPDX-License-Identifier: Apache-2.0
// Borders of blocked zones that lie nearer to a robot than its hull reaches: drawn over its place, or it was carried
// there. Safety lets it come nearer to none of them (navigation/zoned_driving).
#pragma once

#include <string>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/zones.hpp"

namespace deltamap::navigation {

/// Blocked zones that the robot does not stand in and whose border is nearer to its middle than its hull reaches. It
/// turns there, and of all ways ahead only those are left that come nearer to no point of a border.
struct BordersInReach {
  std::vector<std::string> ids{};
  bool leave_a_way = true;  ///< some way ahead is left
};
[[nodiscard]] BordersInReach borders_in_reach(const Zones& zones, const Point2& robot_in_map, double reach_m);

}  // namespace deltamap::navigation
