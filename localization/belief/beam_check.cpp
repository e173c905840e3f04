// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/beam_check.hpp"

#include <algorithm>

#include "core/geometry/pose_spread.hpp"
#include "core/grid/near_occupied.hpp"
#include "localization/sensor/straight_walk.hpp"

namespace deltamap::localization::belief {
namespace {

constexpr std::size_t kBeams = 72;   // of a scan that are looked at, evenly chosen
constexpr double kMostAsideM = 0.3;  // a beam whose place is less certain says nothing

using sensor::first_met;
using sensor::kOutOfTheLaserM;
using sensor::Met;

/// Towards free space, from the cells around; zero inside blocks and on single cells.
Point2 surface_normal(const OccupancyGrid& map, Cell at) {
  int columns = 0;
  int rows = 0;
  map.tiles().visit_around(at, 2, map.geometry(), [&](Cell cell, CellState state) {
    if (state != CellState::kFree) return;
    columns += cell.column - at.column;
    rows += cell.row - at.row;
  });
  const Point2 sum{columns, rows};
  const double length = sum.norm();
  return length > 0.0 ? Point2{sum / length} : Point2{0.0, 0.0};
}

class BeamJudge {
 public:
  BeamJudge(const OccupancyGrid& map, const sensor::RefinedPose& believed, const Scan& scan)
      : map_{map},
        max_range_m_{scan.max_range_m},
        range_deviation_m_{scan.range_deviation_m},
        pose_{believed.map_from_robot},
        deviation_{pose_deviation(believed.covariance)} {}

  [[nodiscard]] CheckedBeam judged(const RayInRobot& ray) const {
    const Point2 from = pose_ * Point2{ray.origin.cast<double>()};
    const Point2 end = pose_ * Point2{ray.end.cast<double>()};
    const double length_m = (end - from).norm();
    const double aside_m = deviation_.aside_m(length_m);
    if (length_m <= kOutOfTheLaserM || aside_m > kMostAsideM) return {};
    const double slack_m = expected_within_m(aside_m, range_deviation_m_) + map_.resolution_m();
    const Point2 along = (end - from) / length_m;

    if (map_.at(map_.geometry().cell_at(from)) != CellState::kFree) return {};  // no view from inside a block
    const Met met = first_met(map_, from, along, kOutOfTheLaserM, length_m - kClearlyBeyondM - slack_m);
    if (met.what == CellState::kUnknown) return {};
    if (met.what == CellState::kOccupied) {
      return is_crossed_beside(from, end, aside_m, slack_m) ? beam(BeamFit::kBeyond, met.cell) : CheckedBeam{};
    }
    if (const auto surface = occupied_near(map_, end, slack_m)) return beam(BeamFit::kFit, *surface);
    const Met hidden = first_met(map_, from, along, length_m, max_range_m_ - slack_m);
    if (hidden.what == CellState::kOccupied) return beam(BeamFit::kShort, hidden.cell);
    return {};
  }

 private:
  [[nodiscard]] CheckedBeam beam(BeamFit what, Cell expected) const {
    return {what, expected, surface_normal(map_, expected)};
  }

  /// Do the outermost beams that the pose may as well have sent also go through an obstacle?
  [[nodiscard]] bool is_crossed_beside(const Point2& from, const Point2& end, double aside_m, double slack_m) const {
    const Point2 ahead = (end - from).normalized();
    const Point2 left{-ahead.y(), ahead.x()};
    for (const double side : {kBeamDeviations, -kBeamDeviations}) {
      const Point2 start = from + side * deviation_.position_m * left;
      const Point2 way = end + side * aside_m * left - start;
      const double length_m = way.norm();
      const Met met = first_met(map_, start, way / length_m, kOutOfTheLaserM, length_m - kClearlyBeyondM - slack_m);
      if (met.what != CellState::kOccupied) return false;
    }
    return true;
  }

  const OccupancyGrid& map_;
  const double max_range_m_;
  const double range_deviation_m_;
  const Pose2 pose_;
  const PoseDeviation deviation_;
};

}  // namespace

std::span<const CheckedBeam> BeamCheck::check(const OccupancyGrid& map, const Scan& scan,
                                              std::span<const RayInRobot> rays, const sensor::RefinedPose& believed) {
  const BeamJudge judge{map, believed, scan};
  const std::size_t count = std::min(rays.size(), kBeams);
  beams_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = i * rays.size() / count;
    beams_.push_back(scan.beams[at].kind == BeamKind::kRange ? judge.judged(rays[at]) : CheckedBeam{});
  }
  return beams_;
}

}  // namespace deltamap::localization::belief
