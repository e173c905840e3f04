// SPDX-License-Identifier: Apache-2.0
#include "navigation/zoned_driving.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::navigation {

std::vector<Point2> blocked_borders(const Zones& zones, const Pose2& map_from_robot, const ZonedDrivingParams& params) {
  std::vector<Point2> points;
  const Pose2 robot_from_map = inverse(map_from_robot);
  const Point2 robot = map_from_robot.position();
  for (const Zone& zone : zones) {
    if (zone.kind != ZoneKind::kBlocked || contains(zone.polygon, robot)) continue;
    for (std::size_t i = 0; i < zone.polygon.size(); ++i) {
      const Point2& from = zone.polygon[i];
      const Point2 side = zone.polygon[(i + 1) % zone.polygon.size()] - from;
      const double length_m = side.norm();
      const int steps = static_cast<int>(std::ceil(length_m / params.step_m));
      // Only the part of a long side that lies around the robot.
      const double middle = (robot - from).dot(side) / (length_m * length_m);
      const double reach = params.within_m / length_m;
      const int first = std::clamp(static_cast<int>(std::floor((middle - reach) * steps)), 0, steps);
      const int last = std::clamp(static_cast<int>(std::ceil((middle + reach) * steps)), 0, steps);
      for (int step = first; step < last; ++step) {
        const Point2 in_map = from + side * (static_cast<double>(step) / steps);
        if ((in_map - robot).norm() <= params.within_m) points.push_back(robot_from_map * in_map);
      }
    }
  }
  return points;
}

ZonesAround zones_around(const Zones& zones, const Pose2& map_from_robot, Timestamp time,
                         const ZonedDrivingParams& params) {
  return {time, blocked_borders(zones, map_from_robot, params), speed_limit_m_per_s(zones, map_from_robot, params)};
}

double speed_limit_m_per_s(const Zones& zones, const Pose2& map_from_robot, const ZonedDrivingParams& params) {
  double limit = std::numeric_limits<double>::infinity();
  const Point2 ahead = map_from_robot * Point2{params.brakes_within_m, 0.0};
  for (const Zone& zone : zones) {
    if (zone.kind != ZoneKind::kSpeedLimit) continue;
    if (contains(zone.polygon, map_from_robot.position()) || contains(zone.polygon, ahead))
      limit = std::min(limit, zone.most_speed_m_per_s);
  }
  return limit;
}

}  // namespace deltamap::navigation
