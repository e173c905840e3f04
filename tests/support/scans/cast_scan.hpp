// SPDX-License-Identifier: Apache-2.0
// Scans of a drawn world: beams end at the first occupied cell, with seeded noise. No motion during the sweep.
#pragma once

#include <numbers>

#include "core/geometry/angle.hpp"
#include "core/grid/grid_ray.hpp"
#include "core/messages.hpp"
#include "core/random.hpp"

namespace deltamap::test {

struct CastScanner {
  double max_range_m = 80.0;
  double noise_m = 0.01;
  std::size_t beams = 181;
  Pose2 robot_from_laser{};
};

/// Distance to where a beam enters the first occupied cell; nothing within the range: negative.
inline double cast_range_m(const OccupancyGrid& world, const Pose2& map_from_laser, double bearing_rad,
                           double max_range_m) {
  const double direction_rad = map_from_laser.theta + bearing_rad;
  const Point2 from = map_from_laser.position();
  const Point2 to = from + max_range_m * Point2{std::cos(direction_rad), std::sin(direction_rad)};
  double range_m = -1.0;
  walk_ray(world.geometry(), from, to, [&](Cell cell, double entered_m) {
    if (!world.geometry().contains(cell)) return false;
    if (world[cell] != CellState::kOccupied) return true;
    range_m = entered_m;
    return false;
  });
  return range_m;
}

inline Scan cast_scan(const OccupancyGrid& world, const Pose2& map_from_robot, Timestamp time,
                      const CastScanner& scanner, Random& random) {
  Scan scan;
  scan.time = time;
  scan.received = time + duration_from_seconds(0.02);
  scan.first_bearing_rad = -std::numbers::pi / 2.0;
  scan.bearing_step_rad = std::numbers::pi / static_cast<double>(scanner.beams - 1);
  scan.max_range_m = scanner.max_range_m;
  scan.robot_from_laser = scanner.robot_from_laser;
  for (std::size_t i = 0; i < scanner.beams; ++i) {
    const double range_m =
        cast_range_m(world, map_from_robot * scanner.robot_from_laser, scan.bearing_rad(i), scanner.max_range_m);
    Beam beam{.range_m = 0.0F, .offset_s = 0.0F, .kind = BeamKind::kBeyondMaximum};
    if (range_m >= 0.0) {
      beam.kind = BeamKind::kRange;
      beam.range_m = static_cast<float>(std::max(0.01, range_m + random.normal(scanner.noise_m)));
    }
    scan.beams.push_back(beam);
  }
  return scan;
}

/// Occupied where the box (metres, map frame) covers a cell's centre; `state` says what is put there.
inline void fill_box(OccupancyGrid& world, Point2 low, Point2 high, CellState state) {
  const Cell first = world.geometry().cell_at(low);
  const Cell last = world.geometry().cell_at(high);
  for (int row = first.row; row <= last.row; ++row) {
    for (int column = first.column; column <= last.column; ++column) {
      const Cell cell{column, row};
      const Point2 centre = world.geometry().centre_of(cell);
      const bool inside =
          centre.x() > low.x() && centre.x() < high.x() && centre.y() > low.y() && centre.y() < high.y();
      if (inside && world.geometry().contains(cell)) world.set(cell, state);
    }
  }
}

}  // namespace deltamap::test
