// SPDX-License-Identifier: Apache-2.0
// What zones ask of whoever drives, pilot or hand: blocked ones are obstacles that no laser sees, and in others the
// robot drives slowly. Both need a pose that holds.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/messages.hpp"
#include "core/zones.hpp"

namespace deltamap::navigation {

struct ZonedDrivingParams {
  double within_m = 8.0;                ///< nearer borders count, from the robot's middle: it stops within them; > 0
  double step_m = 0.1;                  ///< between points of a border; > 0, smaller than the robot
  double brakes_within_m = 0.5;         ///< so far before it a limit holds already; >= 0
  double braking_m_per_s2 = 0.3;        ///< farther before it no more than this brakes to it; > 0
  double leaves_at_most_m_per_s = 0.1;  ///< within a blocked zone; > 0
};

/// What they ask around one pose. Nothing of a pose that does not hold.
struct ZonesAround {
  Timestamp time{};                        ///< of the pose
  bool bind = false;                       ///< the site has zones that say where or how fast to drive
  std::string blocked_around{};            ///< id of the blocked zone that it stands in: not heeded until it has left
  std::vector<Point2> blocked_in_robot{};  ///< in its frame: obstacles that no laser sees
  double most_speed_m_per_s = std::numeric_limits<double>::infinity();
};

[[nodiscard]] ZonesAround zones_around(const Zones& zones, const Pose2& map_from_robot, Timestamp time,
                                       const ZonedDrivingParams& params = {});

/// Points on the borders of blocked zones in the robot's frame. A robot that stands in one may leave it: that one has
/// none.
[[nodiscard]] std::vector<Point2> blocked_borders(const Zones& zones, const Pose2& map_from_robot,
                                                  const ZonedDrivingParams& params = {});

/// The lowest limit of the zones that it is in, or is about to be; before those ahead as much more as it can brake;
/// infinite where there is none.
[[nodiscard]] double speed_limit_m_per_s(const Zones& zones, const Pose2& map_from_robot,
                                         const ZonedDrivingParams& params = {});

}  // namespace deltamap::navigation
