// SPDX-License-Identifier: Apache-2.0
// Scans of a drawn world: beams cast from a pose through a grid, and the estimate that a localizer would have of it.
#pragma once

#include <cmath>
#include <memory>
#include <optional>

#include "core/grid/grid_ray.hpp"
#include "core/messages.hpp"
#include "core/random.hpp"

namespace deltamap::test {

struct DrawnScanParams {
  int beams = 181;            ///< over 180°
  double max_range_m = 20.0;  ///< longer ones bring nothing back
  double range_deviation_m = 0.01;
  double position_deviation_m = 0.0;  ///< of the estimate around the true pose
  double heading_deviation_rad = 0.0;
};

/// How far the first occupied cell is, to the middle of the beam's way through it.
inline std::optional<double> drawn_range_m(const OccupancyGrid& world, const Point2& from, double heading_rad,
                                           double max_range_m) {
  std::optional<double> range_m;
  const Point2 to = from + max_range_m * Point2{std::cos(heading_rad), std::sin(heading_rad)};
  walk_ray(world.geometry(), from, to, [&](Cell cell, double entered_m) {
    if (world.at(cell) == CellState::kOccupied) range_m = entered_m + 0.4 * world.resolution_m();
    return !range_m;
  });
  return range_m;
}

/// What the robot at `true_pose` in `world` measures and believes, with `map` as its map.
inline TrackedScan drawn_scan(const OccupancyGrid& world, std::shared_ptr<const OccupancyGrid> map,
                              const Pose2& true_pose, double time_s, Random& random,
                              const DrawnScanParams& params = {}) {
  TrackedScan tracked;
  Scan& scan = tracked.scan;
  scan.time = timestamp_from_ns(1'000'000'000'000) + duration_from_seconds(time_s);
  scan.first_bearing_rad = -std::numbers::pi / 2.0;
  scan.bearing_step_rad = std::numbers::pi / (params.beams - 1);
  scan.max_range_m = params.max_range_m;
  for (int i = 0; i < params.beams; ++i) {
    const double bearing_rad = scan.bearing_rad(static_cast<std::size_t>(i));
    const auto range_m = drawn_range_m(world, true_pose.position(), true_pose.theta + bearing_rad, params.max_range_m);
    Beam beam;
    beam.kind = range_m ? BeamKind::kRange : BeamKind::kBeyondMaximum;
    if (range_m) beam.range_m = static_cast<float>(std::max(0.01, *range_m + random.normal(params.range_deviation_m)));
    scan.beams.push_back(beam);
    const Point2 end = beam.range_m * Point2{std::cos(bearing_rad), std::sin(bearing_rad)};
    tracked.rays.push_back({{0.0F, 0.0F}, end.cast<float>()});
  }
  Estimate& estimate = tracked.estimate;
  estimate.time = scan.time;
  estimate.map_from_robot = {true_pose.x + random.normal(params.position_deviation_m),
                             true_pose.y + random.normal(params.position_deviation_m),
                             wrapped_angle(true_pose.theta + random.normal(params.heading_deviation_rad))};
  estimate.covariance = Eigen::Vector3d{9e-4, 9e-4, 7.6e-5}.asDiagonal();  // (0.03 m, 0.03 m, 0.5°)²
  estimate.state = LocalizerState::kTracking;
  estimate.particles = 500;
  estimate.n_eff = 400.0;
  estimate.w_avg = 0.5;
  estimate.belief.pose_right = 0.95;
  estimate.belief.elsewhere = {.expected = 60, .fit = 60};
  estimate.map = std::move(map);
  tracked.odom_from_robot = true_pose;
  return tracked;
}

}  // namespace deltamap::test
