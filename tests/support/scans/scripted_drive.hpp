// SPDX-License-Identifier: Apache-2.0
// A short drive through a small room in which a box appears half way, as a CARMEN log: what the daemon's tests import,
// play to the live pipeline and replay.
#pragma once

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "core/geometry/pose2.hpp"
#include "core/grid/grid_ray.hpp"
#include "core/grid/occupancy_grid.hpp"
#include "core/random.hpp"

namespace deltamap::test {

/// 10 × 8 m at 0.05 m: walls, a partition and a niche, so that each place looks different.
inline OccupancyGrid small_room(bool with_box) {
  OccupancyGrid room{{200, 160, 0.05, {0.0, 0.0}}, CellState::kFree};
  const auto fill = [&](int left, int low, int right, int high) {
    for (int row = low; row < high; ++row) {
      for (int column = left; column < right; ++column) room.set({column, row}, CellState::kOccupied);
    }
  };
  fill(0, 0, 200, 3);
  fill(0, 157, 200, 160);
  fill(0, 0, 3, 160);
  fill(197, 0, 200, 160);
  fill(90, 0, 94, 40);
  fill(20, 120, 40, 160);
  fill(150, 130, 158, 160);
  if (with_box) fill(96, 96, 116, 112);
  return room;
}

inline double range_in(const OccupancyGrid& world, const Pose2& map_from_laser, double bearing_rad) {
  constexpr double kLongest_m = 15.0;
  const double heading = map_from_laser.theta + bearing_rad;
  const Point2 from = map_from_laser.position();
  const Point2 to = from + kLongest_m * Point2{std::cos(heading), std::sin(heading)};
  double range_m = kLongest_m;
  walk_ray(world.geometry(), from, to, [&](Cell cell, double entered_m) {
    if (world.at(cell) != CellState::kOccupied) return true;
    range_m = entered_m;
    return false;
  });
  return range_m;
}

/// On an ellipse round the middle of the room; map and odometry frame are the same.
inline Pose2 pose_on_drive(double time_s) {
  const double angle = 2.0 * std::numbers::pi * time_s / 30.0;
  const double x = 5.0 + 2.6 * std::cos(angle);
  const double y = 4.6 + 1.7 * std::sin(angle);
  return {x, y, std::atan2(1.7 * std::cos(angle), -2.6 * std::sin(angle))};
}

/// `seconds` of driving at 9.4 scans a second; the box stands there from the third part on.
inline void write_drive(const std::filesystem::path& log, double seconds) {
  const OccupancyGrid before = small_room(false);
  const OccupancyGrid after = small_room(true);
  Random random{42};
  std::ofstream out(log);
  char text[64];
  for (int scan = 0; scan * 0.106 < seconds; ++scan) {
    const double time_s = scan * 0.106;
    const Pose2 pose = pose_on_drive(time_s);
    out << "FLASER 180";
    for (int beam = 0; beam < 180; ++beam) {
      const double range = range_in(time_s < seconds / 3.0 ? before : after, pose, radians(beam - 90.0));
      (void)std::snprintf(text, sizeof text, " %.3f", range + random.normal(0.008));
      out << text;
    }
    for (int twice = 0; twice < 2; ++twice) {
      (void)std::snprintf(text, sizeof text, " %.6f %.6f %.6f", pose.x, pose.y, pose.theta);
      out << text;
    }
    (void)std::snprintf(text, sizeof text, " %.6f test %.6f\n", 1e9 + time_s, time_s);
    out << text;
  }
}

}  // namespace deltamap::test
