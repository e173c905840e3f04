// SPDX-License-Identifier: Apache-2.0
#include "navigation/zoned_driving.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/geometry/angle.hpp"

namespace deltamap::navigation {
namespace {

// A robot on an arc meets what does not lie straight ahead.
constexpr std::array<double, 3> kAsideRad{0.0, radians(20.0), -radians(20.0)};

Point2 ahead_of(const Pose2& map_from_robot, double ahead_m, double aside_rad) {
  return map_from_robot * Point2{ahead_m * std::cos(aside_rad), ahead_m * std::sin(aside_rad)};
}

/// How far the zone lies ahead, to either side, too; 0 where the robot is in it; nothing beyond `within_m`.
std::optional<double> way_to_m(const Zone& zone, const Pose2& map_from_robot, const ZonedDrivingParams& params) {
  Polygon looked_at{map_from_robot.position()};
  for (const double aside_rad : kAsideRad) looked_at.push_back(ahead_of(map_from_robot, params.within_m, aside_rad));
  if (!bounding_box(zone.polygon).meets(bounding_box(looked_at))) return std::nullopt;
  if (contains(zone.polygon, map_from_robot.position())) return 0.0;
  const int steps = static_cast<int>(params.within_m / params.step_m);
  for (int step = 1; step <= steps; ++step) {
    const double ahead_m = step * params.step_m;
    for (const double aside_rad : kAsideRad) {
      if (contains(zone.polygon, ahead_of(map_from_robot, ahead_m, aside_rad))) return ahead_m;
    }
  }
  return std::nullopt;
}

}  // namespace

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
  ZonesAround around{.time = time,
                     .blocked_in_robot = blocked_borders(zones, map_from_robot, params),
                     .most_speed_m_per_s = speed_limit_m_per_s(zones, map_from_robot, params)};
  for (const Zone& zone : zones) {
    around.bind = around.bind || zone.kind == ZoneKind::kBlocked || zone.kind == ZoneKind::kSpeedLimit;
    if (zone.kind != ZoneKind::kBlocked || !contains(zone.polygon, map_from_robot.position())) continue;
    around.blocked_around = zone.id;
    around.most_speed_m_per_s = std::min(around.most_speed_m_per_s, params.leaves_at_most_m_per_s);
  }
  return around;
}

double speed_limit_m_per_s(const Zones& zones, const Pose2& map_from_robot, const ZonedDrivingParams& params) {
  double limit = std::numeric_limits<double>::infinity();
  for (const Zone& zone : zones) {
    if (zone.kind != ZoneKind::kSpeedLimit) continue;
    const auto way_m = way_to_m(zone, map_from_robot, params);
    if (!way_m) continue;
    const double brakes_m = std::max(0.0, *way_m - params.brakes_within_m);
    const double most = zone.most_speed_m_per_s;
    limit = std::min(limit, std::sqrt(most * most + 2.0 * params.braking_m_per_s2 * brakes_m));
  }
  return limit;
}

}  // namespace deltamap::navigation
