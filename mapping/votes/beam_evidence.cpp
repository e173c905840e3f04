// SPDX-License-Identifier: Apache-2.0
#include "mapping/votes/beam_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/geometry/points_in_map.hpp"
#include "core/grid/near_occupied.hpp"
#include "mapping/votes/pose_deviation.hpp"

namespace deltamap::mapping::votes {
namespace {

/// A face met at a slant lies farther along for a beam beside: up to so many times as far as the beam lies aside (14°).
constexpr double kMostSlant = 4.0;

bool has_surface_within(const OccupancyGrid& map, const ClearSpace& clear, const Point2& place, double radius_m) {
  const Cell centre = map.geometry().cell_at(place);
  const bool is_clear =
      map.geometry().contains(centre) && clear.clear_cells_around(centre) * map.resolution_m() >= radius_m;
  return !is_clear && occupied_near(map, place, radius_m);
}

struct Passage {
  double entered_m;
  double left_m;
  std::size_t first;  // into BeamVerdict::passed
};

class BeamJudge {
 public:
  BeamJudge(const OccupancyGrid& map, const ClearSpace& clear, const PoseDeviation& deviation)
      : map_{map}, clear_{clear}, deviation_{deviation} {}

  /// The occupied cells in the beam's way that it has clearly left behind, for every pose within the uncertainty.
  void collect_passed(BeamVerdict& beam) const {
    const double limit_m = beam.length_m - kClearlyBeyondM - beam.interval_m;
    if (limit_m <= 0.0) return;
    std::optional<Passage> passage;
    const double gap_m = 2.5 * map_.resolution_m();
    const Point2 limit = beam.from + (beam.end - beam.from) * (limit_m / beam.length_m);
    walk_surfaces(map_, clear_, beam.from, limit, [&](Cell cell, double entered_m, double before_m) {
      if (passage && before_m > passage->left_m + gap_m) {
        close(beam, *passage);
        passage.reset();
      }
      if (!passage) passage = Passage{entered_m, entered_m, beam.passed.size()};
      passage->left_m = entered_m + map_.resolution_m();
      beam.passed.push_back(cell);
      return true;
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
    const double near_m = kBeamDeviations * deviation_.position_m;
    const double far_m = kBeamDeviations * deviation_.aside_m(beam.length_m);
    const double slack_m = kClearlyBeyondM + near_m + kMostSlant * (far_m - near_m);
    for (const double side : {1.0, -1.0}) {
      const Point2 from = beam.from + side * near_m * left;
      const Point2 end = beam.end + side * far_m * left;
      if (!meets_surface_between(from, end, passage.entered_m - slack_m,
                                 std::min(passage.left_m + slack_m, beam.length_m - beam.interval_m))) {
        return false;
      }
    }
    return true;
  }

  /// Does a neighbouring beam, which the robot's pose could as well have sent, meet a surface about as far away?
  [[nodiscard]] bool meets_surface_between(const Point2& from, const Point2& to, double nearest_m,
                                           double farthest_m) const {
    const double length_m = (to - from).norm();
    if (length_m <= nearest_m) return false;
    const Point2 along = (to - from) / length_m;
    bool met = false;
    walk_surfaces(map_, clear_, from + std::max(0.0, nearest_m) * along, from + std::min(length_m, farthest_m) * along,
                  [&](Cell, double, double) {
                    met = true;
                    return false;
                  });
    return met;
  }

  const OccupancyGrid& map_;
  const ClearSpace& clear_;
  const PoseDeviation deviation_;
};

}  // namespace

bool speaks(const Estimate& estimate, double turn_rate_rad_per_s, const BeamEvidenceParams& params) {
  if (estimate.state != LocalizerState::kTracking) return false;
  const PoseDeviation deviation = pose_deviation(estimate, turn_rate_rad_per_s);
  return deviation.position_m <= params.most_position_deviation_m &&
         deviation.heading_rad <= params.most_heading_deviation_rad;
}

std::vector<BeamVerdict> beam_evidence(const OccupancyGrid& map, const ClearSpace& clear, const TrackedScan& tracked,
                                       const BeamEvidenceParams& params, std::vector<BeamVerdict> verdicts) {
  verdicts.resize(tracked.rays.size());
  const bool silent = !speaks(tracked.estimate, tracked.turn_rate_rad_per_s, params);
  const PoseDeviation deviation = pose_deviation(tracked.estimate, tracked.turn_rate_rad_per_s);
  const BeamJudge judge{map, clear, deviation};
  const double farthest_m =
      std::min(params.most_range_m, std::sqrt(std::max(0.0, params.most_aside_m * params.most_aside_m -
                                                                deviation.position_m * deviation.position_m)) /
                                        deviation.heading_rad);
  const PointsInMap in_map{tracked.estimate.map_from_robot};
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    BeamVerdict& beam = verdicts[i];
    beam.passed.clear();
    beam.length_m = 0.0;
    beam.ends_at_surface = true;
    beam.ends_off_map = false;
    if (silent || tracked.scan.beams[i].kind != BeamKind::kRange) continue;
    const RayInRobot& ray = tracked.rays[i];
    beam.from = in_map(ray.origin);
    beam.end = in_map(ray.end);
    beam.length_m = (beam.end - beam.from).norm();
    if (beam.length_m <= 0.0) continue;
    beam.ends_at_surface = beam.length_m <= farthest_m;
    if (!beam.ends_at_surface) {
      beam.end = beam.from + (beam.end - beam.from) * (farthest_m / beam.length_m);
      beam.length_m = farthest_m;
    }
    beam.interval_m = expected_within_m(deviation.aside_m(beam.length_m), tracked.scan.range_deviation_m);

    judge.collect_passed(beam);
    beam.ends_off_map =
        beam.ends_at_surface && !has_surface_within(map, clear, beam.end, beam.interval_m + map.resolution_m());
  }
  return verdicts;
}

}  // namespace deltamap::mapping::votes
