// SPDX-License-Identifier: Apache-2.0
#include "mapping/awareness/beam_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/grid_ray.hpp"

namespace deltamap::mapping::awareness {
namespace {

/// A face met at a slant lies farther along for a beam beside: up to so many times as far as the beam lies aside (14°).
constexpr double kMostSlant = 4.0;

struct PoseDeviation {
  double position_m;
  double heading_rad;
};

PoseDeviation pose_deviation(const Estimate& estimate, double turn_rate_rad_per_s, const BeamEvidenceParams& params) {
  const PoseCovariance& c = estimate.covariance;
  const double heading = std::sqrt(std::max(0.0, c(2, 2)));
  return {std::hypot(std::sqrt(std::max(0.0, std::max(c(0, 0), c(1, 1)))), params.least_position_deviation_m),
          std::hypot(heading, params.least_heading_deviation_rad) +
              std::abs(turn_rate_rad_per_s) * params.clock_deviation_s};
}

/// How far aside a beam may lie from where the pose puts it, at a distance from the laser.
double aside_m(const PoseDeviation& deviation, double distance_m) {
  return std::hypot(deviation.position_m, distance_m * deviation.heading_rad);
}

bool has_surface_within(const OccupancyGrid& map, const Point2& place, double radius_m) {
  const GridGeometry& geometry = map.geometry();
  const Cell centre = geometry.cell_at(place);
  if (map.at(centre) == CellState::kOccupied) return true;
  const int reach = static_cast<int>(std::ceil(radius_m / geometry.resolution_m));
  const double radius2 = radius_m * radius_m;
  for (int ring = 1; ring <= reach; ++ring) {
    for (int row = -ring; row <= ring; ++row) {
      const int step = std::abs(row) == ring ? 1 : 2 * ring;
      for (int column = -ring; column <= ring; column += step) {
        const Cell cell{centre.column + column, centre.row + row};
        if (map.at(cell) == CellState::kOccupied && (geometry.centre_of(cell) - place).squaredNorm() <= radius2) {
          return true;
        }
      }
    }
  }
  return false;
}

/// Does a neighbouring beam, which the robot's pose could as well have sent, meet a surface about as far away?
bool meets_surface_between(const OccupancyGrid& map, const Point2& from, const Point2& to, double nearest_m,
                           double farthest_m) {
  const double length_m = (to - from).norm();
  if (length_m <= nearest_m) return false;
  const Point2 along = (to - from) / length_m;
  bool met = false;
  const Point2 start = from + std::max(0.0, nearest_m) * along;
  const Point2 stop = from + std::min(length_m, farthest_m) * along;
  walk_ray(map.geometry(), start, stop, [&](Cell cell, double) {
    met = map.at(cell) == CellState::kOccupied;
    return !met;
  });
  return met;
}

struct Passage {
  double entered_m;
  double left_m;
  std::size_t first;  // into BeamVerdict::passed
};

class BeamJudge {
 public:
  BeamJudge(const OccupancyGrid& map, const PoseDeviation& deviation, const BeamEvidenceParams& params)
      : map_{map}, deviation_{deviation}, params_{params} {}

  /// The occupied cells in the beam's way that it has clearly left behind, for every pose within the uncertainty.
  void collect_passed(BeamVerdict& beam) const {
    const double limit_m = beam.length_m - params_.beyond_m - beam.interval_m;
    if (limit_m <= 0.0) return;
    std::optional<Passage> passage;
    const double gap_m = 2.5 * map_.resolution_m();
    walk_ray(map_.geometry(), beam.from, beam.end, [&](Cell cell, double entered_m) {
      if (map_.at(cell) == CellState::kOccupied) {
        if (!passage) passage = Passage{entered_m, entered_m, beam.passed.size()};
        if (entered_m > limit_m) return false;  // the beam ends inside: it has passed what lies before
        passage->left_m = entered_m + map_.resolution_m();
        beam.passed.push_back(cell);
      } else if (passage && entered_m > passage->left_m + gap_m) {
        close(beam, *passage);
        passage.reset();
      }
      return entered_m <= limit_m || passage.has_value();
    });
    if (passage) close(beam, *passage);
  }

 private:
  /// Keeps the cells of a passage only where the beam ends beyond it and its neighbours on both sides cross it too.
  void close(BeamVerdict& beam, const Passage& passage) const {
    if (!crosses_for_every_pose(beam, passage)) beam.passed.resize(passage.first);
  }

  [[nodiscard]] bool crosses_for_every_pose(const BeamVerdict& beam, const Passage& passage) const {
    const Point2 along = (beam.end - beam.from) / beam.length_m;
    const Point2 left{-along.y(), along.x()};
    const double near_m = params_.deviations * deviation_.position_m;
    const double far_m = params_.deviations * aside_m(deviation_, beam.length_m);
    const double slack_m = params_.beyond_m + near_m + kMostSlant * (far_m - near_m);
    for (const double side : {1.0, -1.0}) {
      const Point2 from = beam.from + side * near_m * left;
      const Point2 end = beam.end + side * far_m * left;
      if (!meets_surface_between(map_, from, end, passage.entered_m - slack_m,
                                 std::min(passage.left_m + slack_m, beam.length_m - beam.interval_m))) {
        return false;
      }
    }
    return true;
  }

  const OccupancyGrid& map_;
  const PoseDeviation deviation_;
  const BeamEvidenceParams& params_;
};

}  // namespace

bool speaks(const Estimate& estimate, double turn_rate_rad_per_s, const BeamEvidenceParams& params) {
  if (estimate.state != LocalizerState::kTracking) return false;
  const PoseDeviation deviation = pose_deviation(estimate, turn_rate_rad_per_s, params);
  return deviation.position_m <= params.most_position_deviation_m &&
         deviation.heading_rad <= params.most_heading_deviation_rad;
}

std::vector<BeamVerdict> beam_evidence(const OccupancyGrid& map, const TrackedScan& tracked,
                                       const BeamEvidenceParams& params, std::vector<BeamVerdict> verdicts) {
  verdicts.resize(tracked.rays.size());
  const bool silent = !speaks(tracked.estimate, tracked.turn_rate_rad_per_s, params);
  const PoseDeviation deviation = pose_deviation(tracked.estimate, tracked.turn_rate_rad_per_s, params);
  const BeamJudge judge{map, deviation, params};
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    BeamVerdict& beam = verdicts[i];
    std::vector<Cell> memory = std::move(beam.passed);
    memory.clear();
    beam = BeamVerdict{};
    beam.passed = std::move(memory);
    if (silent || tracked.scan.beams[i].kind != BeamKind::kRange) continue;
    const RayInRobot& ray = tracked.rays[i];
    beam.from = tracked.estimate.map_from_robot * Point2{ray.origin.cast<double>()};
    beam.end = tracked.estimate.map_from_robot * Point2{ray.end.cast<double>()};
    beam.length_m = (beam.end - beam.from).norm();
    if (beam.length_m <= 0.0) continue;
    const double farthest_m =
        std::min(params.most_range_m, std::sqrt(std::max(0.0, params.most_aside_m * params.most_aside_m -
                                                                  deviation.position_m * deviation.position_m)) /
                                          deviation.heading_rad);
    beam.ends_at_surface = beam.length_m <= farthest_m;
    if (!beam.ends_at_surface) {
      beam.end = beam.from + (beam.end - beam.from) * (farthest_m / beam.length_m);
      beam.length_m = farthest_m;
    }
    beam.interval_m = params.deviations * std::hypot(aside_m(deviation, beam.length_m), params.range_deviation_m);

    judge.collect_passed(beam);
    beam.ends_off_map =
        beam.ends_at_surface && !has_surface_within(map, beam.end, beam.interval_m + map.resolution_m());
    if (!beam.passed.empty()) {
      beam.what = BeamClass::kThrough;
    } else if (beam.ends_off_map) {
      const bool on_unknown = map.at(map.geometry().cell_at(beam.end)) == CellState::kUnknown;
      beam.what = on_unknown ? BeamClass::kUnknown : BeamClass::kShort;
    } else if (beam.ends_at_surface) {
      beam.what = BeamClass::kConsistent;
    }
  }
  return verdicts;
}

}  // namespace deltamap::mapping::awareness
