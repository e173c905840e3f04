// SPDX-License-Identifier: Apache-2.0
#include "navigation/borders_in_reach.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "navigation/zoned_driving.hpp"

namespace deltamap::navigation {
namespace {

constexpr double kReachStepM = 0.02;  // between points of a border beside the hull

}  // namespace

BordersInReach borders_in_reach(const Zones& zones, const Point2& robot_in_map, double reach_m) {
  const Pose2 robot{robot_in_map.x(), robot_in_map.y(), 0.0};
  BordersInReach in_reach;
  std::vector<double> bearings_rad;
  for (const Zone& zone : zones) {
    const auto points = blocked_borders({zone}, robot, {.within_m = reach_m, .step_m = kReachStepM});
    if (!points.empty()) in_reach.ids.push_back(zone.id);
    for (const Point2& point : points) bearings_rad.push_back(std::atan2(point.y(), point.x()));
  }
  if (bearings_rad.empty()) return in_reach;
  std::sort(bearings_rad.begin(), bearings_rad.end());
  double widest_gap_rad = bearings_rad.front() + 2.0 * std::numbers::pi - bearings_rad.back();
  for (std::size_t i = 1; i < bearings_rad.size(); ++i)
    widest_gap_rad = std::max(widest_gap_rad, bearings_rad[i] - bearings_rad[i - 1]);
  in_reach.leave_a_way = widest_gap_rad > std::numbers::pi - 1e-6;
  return in_reach;
}

}  // namespace deltamap::navigation
