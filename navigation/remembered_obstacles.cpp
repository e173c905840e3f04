// SPDX-License-Identifier: Apache-2.0
#include "navigation/remembered_obstacles.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::navigation {
namespace {

bool passes(const Beam& beam, double range_m) {
  return beam.kind == BeamKind::kBeyondMaximum || (beam.kind == BeamKind::kRange && beam.range_m >= range_m);
}

/// Do all beams that cross the disc around a place end clearly behind it? Not where none does.
bool is_seen_through(const Scan& scan, const Point2& place_in_robot, double radius_m, double clear_m) {
  const Point2 place_in_laser = inverse(scan.robot_from_laser) * place_in_robot;
  const double away_m = place_in_laser.norm();
  if (away_m <= radius_m || scan.bearing_step_rad <= 0.0) return false;
  const double half_rad = std::asin(radius_m / away_m);
  const double bearing_rad = std::atan2(place_in_laser.y(), place_in_laser.x());
  const auto beam_at = [&](double at_rad) { return (at_rad - scan.first_bearing_rad) / scan.bearing_step_rad; };
  const double first = std::ceil(beam_at(bearing_rad - half_rad));
  const double last = std::floor(beam_at(bearing_rad + half_rad));
  if (first < 0.0 || last >= static_cast<double>(scan.beams.size()) || first > last) return false;
  return std::all_of(scan.beams.begin() + static_cast<std::ptrdiff_t>(first),
                     scan.beams.begin() + static_cast<std::ptrdiff_t>(last) + 1,
                     [&](const Beam& beam) { return passes(beam, away_m + clear_m); });
}

}  // namespace

std::vector<Point2> remembered_obstacles(const TransientObstacles& transients, const TrackedScan& tracked,
                                         const RememberedParams& params) {
  std::vector<Point2> obstacles;
  if (tracked.estimate.state != LocalizerState::kTracking) return obstacles;
  const Pose2 robot_from_map = inverse(tracked.estimate.map_from_robot);
  for (const std::uint32_t block : transients.standing) {
    const Point2 middle = robot_from_map * transients.blocks.centre_of(transients.blocks.cell_of(block));
    const double away_m = middle.norm();
    if (away_m > params.within_m || away_m < params.hull_m) continue;
    if (is_seen_through(tracked.scan, middle, 0.5 * transients.blocks.resolution_m, params.clear_m)) continue;
    obstacles.push_back(middle);
  }
  return obstacles;
}

}  // namespace deltamap::navigation
