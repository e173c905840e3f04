// SPDX-License-Identifier: Apache-2.0
#include "simulation/drawn/first_drive.hpp"

#include <cmath>
#include <vector>

#include "core/geometry/angle.hpp"
#include "core/grid/grid_ray.hpp"
#include "simulation/scenario/start_map.hpp"

namespace deltamap::simulation::drawn {
namespace {

constexpr double kMinutes = 20.0;
constexpr double kScanEvery_s = 0.5;
constexpr double kSpeed_m_per_s = 0.8;
// What a good SLAM leaves of an error, and the way over which it changes.
constexpr double kPosition_m = 0.012;
constexpr double kHeading_rad = radians(0.15);
constexpr double kCorrelation_s = 15.0;
constexpr double kMostTurned_rad_per_s = 0.2;  // faster scans are left out
constexpr int kLeastHits = 2;
constexpr double kOccupiedShare = 0.35;  // of the beams that touch a cell
constexpr int kLeastPasses = 2;

struct Counts {
  std::vector<int> hits;
  std::vector<int> passes;
};

/// A first-order Gauss-Markov error of the survey's poses.
class PoseNoise {
 public:
  explicit PoseNoise(Random random) : random_{random} {}
  [[nodiscard]] Pose2 next(double dt_s) {
    const double kept = std::exp(-dt_s / kCorrelation_s);
    const double fresh = std::sqrt(1.0 - kept * kept);
    error_.x = kept * error_.x + fresh * random_.normal(kPosition_m);
    error_.y = kept * error_.y + fresh * random_.normal(kPosition_m);
    error_.theta = kept * error_.theta + fresh * random_.normal(kHeading_rad);
    return error_;
  }

 private:
  Random random_;
  Pose2 error_;
};

void count(const Scan& scan, const Pose2& map_from_laser, const GridGeometry& geometry, Counts& counts) {
  for (std::size_t i = 0; i < scan.beams.size(); ++i) {
    const Beam& beam = scan.beams[i];
    if (beam.kind != BeamKind::kRange) continue;
    const double bearing_rad = map_from_laser.theta + scan.bearing_rad(i);
    const Point2 end = map_from_laser.position() +
                       static_cast<double>(beam.range_m) * Point2{std::cos(bearing_rad), std::sin(bearing_rad)};
    const Cell last = geometry.cell_at(end);
    walk_ray(geometry, map_from_laser.position(), end, [&](Cell cell, double) {
      if (geometry.contains(cell) && cell != last) ++counts.passes[geometry.index_of(cell)];
      return true;
    });
    if (geometry.contains(last)) ++counts.hits[geometry.index_of(last)];
  }
}

VirtualDriveParams survey_of(const VirtualDriveParams& drive) {
  VirtualDriveParams survey;
  survey.seed = drive.seed + 1'000'000;  // another drive than the one to come
  survey.fan = {180, 50};
  survey.max_range_m = drive.max_range_m;
  survey.scan_period_s = kScanEvery_s;
  survey.route = drive.route;
  survey.route.speed_m_per_s = kSpeed_m_per_s;
  return survey;
}

}  // namespace

OccupancyGrid map_of_first_drive(const Drawn& drawn, double resolution_m, Random random) {
  Scenario deserted = drawn.scenario;
  deserted.people.clear();
  deserted.actors.clear();
  OccupancyGrid map{start_map(deserted, resolution_m).geometry()};
  const GridGeometry& geometry = map.geometry();
  Counts counts{std::vector<int>(geometry.cell_count(), 0), std::vector<int>(geometry.cell_count(), 0)};
  VirtualDrive drive{deserted, survey_of(drawn.drive)};
  PoseNoise noise{random};
  Pose2 before = drive.map_from_robot();
  for (double passed_s = 0.0; passed_s < 60.0 * kMinutes; passed_s += kScanEvery_s) {
    const DriveStep step = drive.next();
    const double turned_rad = std::abs(turn_between(before.theta, step.map_from_robot.theta));
    before = step.map_from_robot;
    const Pose2 error = noise.next(kScanEvery_s);
    if (turned_rad > kMostTurned_rad_per_s * kScanEvery_s) continue;
    const Pose2 believed{before.x + error.x, before.y + error.y, before.theta + error.theta};
    count(step.scan, believed * step.scan.robot_from_laser, geometry, counts);
  }
  for (std::size_t i = 0; i < geometry.cell_count(); ++i) {
    const int hits = counts.hits[i];
    const int passes = counts.passes[i];
    if (hits >= kLeastHits && hits >= kOccupiedShare * (hits + passes)) {
      map.set(geometry.cell_of(i), CellState::kOccupied);
    } else if (passes >= kLeastPasses) {
      map.set(geometry.cell_of(i), CellState::kFree);
    }
  }
  return map;
}

}  // namespace deltamap::simulation::drawn
