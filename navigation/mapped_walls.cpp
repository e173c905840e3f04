// SPDX-License-Identifier: Apache-2.0
#include "navigation/mapped_walls.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/grid/grid_ray.hpp"
#include "navigation/laser_watch.hpp"

namespace deltamap::navigation {
namespace {

constexpr double kStepRad = radians(2.0);  // at 3 m a tenth of a metre apart
constexpr double kReachShare = 0.9;        // of the laser's range: what lies beyond may be missed
constexpr double kOpenShare = 1.0 / 12.0;  // of the fan may miss walls: a sector that has so few left is open again
constexpr double kKnownShare = 0.5;        // of a ray's length on known floor: the map knows that direction

struct Met {
  std::optional<double> wall_m;
  double known_share = 0.0;
};

/// Along a direction of the map, as far as `reach_m`.
Met met_on(const OccupancyGrid& map, const Point2& from, double direction_rad, double reach_m) {
  const Point2 to = from + reach_m * Point2{std::cos(direction_rad), std::sin(direction_rad)};
  Met met;
  int cells = 0;
  int known = 0;
  walk_ray(map.geometry(), from, to, [&](Cell cell, double entered_m) {
    if (!map.geometry().contains(cell)) return false;
    const CellState state = map.at(cell);
    ++cells;
    known += state == CellState::kUnknown ? 0 : 1;
    if (state == CellState::kOccupied) met.wall_m = entered_m;
    return state != CellState::kOccupied;
  });
  met.known_share = known * map.geometry().resolution_m / reach_m;
  return met;
}

bool is_tracked(const TrackedScan& tracked) {
  return tracked.estimate.state == LocalizerState::kTracking && tracked.estimate.map != nullptr &&
         tracked.scan.bearing_step_rad != 0.0;
}

Met met_by(const TrackedScan& tracked, std::size_t beam, double reach_m) {
  const Pose2 map_from_laser = tracked.estimate.map_from_robot * tracked.scan.robot_from_laser;
  return met_on(*tracked.estimate.map, map_from_laser.position(), map_from_laser.theta + tracked.scan.bearing_rad(beam),
                reach_m);
}

}  // namespace

std::size_t beams_between(const Scan& scan) {
  if (scan.bearing_step_rad == 0.0) return 1;
  return static_cast<std::size_t>(std::max(1.0, std::floor(kStepRad / std::abs(scan.bearing_step_rad) + 1e-6)));
}

std::optional<double> mapped_wall_m(const TrackedScan& tracked, std::size_t beam) {
  if (tracked.estimate.map == nullptr) return std::nullopt;
  return met_by(tracked, beam, kReachShare * tracked.scan.max_range_m).wall_m;
}

std::vector<Point2> walls_behind_lost_beams(const TrackedScan& tracked, double within_m) {
  std::vector<Point2> walls;
  if (!is_tracked(tracked)) return walls;
  const Scan& scan = tracked.scan;
  for (std::size_t i = 0; i < scan.beams.size(); i += beams_between(scan)) {
    if (scan.beams[i].kind == BeamKind::kRange) continue;
    const double bearing = scan.bearing_rad(i);
    const Met met = met_by(tracked, i, within_m);
    if (met.wall_m)
      walls.push_back(scan.robot_from_laser * Point2{*met.wall_m * std::cos(bearing), *met.wall_m * std::sin(bearing)});
  }
  return walls;
}

bool expects_no_range(const TrackedScan& tracked) {
  if (!is_tracked(tracked)) return false;
  const Scan& scan = tracked.scan;
  int looks = 0;
  int lost = 0;
  int known = 0;
  int missed = 0;
  for (std::size_t i = 0; i < scan.beams.size(); i += 2 * beams_between(scan)) {
    ++looks;
    if (scan.beams[i].kind == BeamKind::kRange) continue;
    const Met met = met_by(tracked, i, kReachShare * scan.max_range_m);
    ++lost;
    missed += met.wall_m ? 1 : 0;
    known += met.known_share >= kKnownShare ? 1 : 0;
  }
  const double most_missed = brings_nothing(scan) ? 0.0 : kOpenShare * looks;
  return missed <= most_missed && 2 * known >= lost;
}

}  // namespace deltamap::navigation
