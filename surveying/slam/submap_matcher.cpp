// SPDX-License-Identifier: Apache-2.0
// Why two steps: closest lines find the minimum next to where they begin and no other; correlation finds the best pose
// of the whole window, but only to the width of its lattice.
#include "surveying/slam/submap_matcher.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/geometry/points_in_map.hpp"
#include "core/geometry/pose_spread.hpp"

namespace deltamap::surveying::slam {
namespace {

constexpr double kDeviations = 3.0;  // in which a scan is searched
constexpr double kCorrelationCellM = 0.1;
constexpr int kMostLevels = 7;
constexpr std::size_t kMostCorrelated = 500;  // ends of a scan, evenly
constexpr double kTableCellM = 0.1;
constexpr double kReachM = 0.3;  // a pose of the lattice is off by a cell
constexpr double kLastReachM = 0.12;
constexpr double kMostCorrectionM = 0.3;  // from the lattice's pose: farther is another minimum
constexpr double kMostCorrectionRad = 0.1;
constexpr double kFlatShare = 0.9;         // of the best score: the search does not tell the poses apart
constexpr double kIndependentShare = 0.1;  // of the ends whose errors are their own
constexpr double kUnobservedM = 1.0;       // 1 σ along an axis that the ends do not observe (a corridor)
constexpr double kUnobservedRad = 0.2;

SearchWindow window_around(const std::vector<Point2>& ends) {
  if (ends.empty()) return {};
  Point2 low = ends.front();
  Point2 high = low;
  for (const Point2& end : ends) {
    low = low.cwiseMin(end);
    high = high.cwiseMax(end);
  }
  const Point2 middle = 0.5 * (low + high);
  return {{middle.x(), middle.y(), 0.0}, 0.5 * (high - low).maxCoeff(), std::numbers::pi};
}

/// As coarse as a window of that size asks for.
int levels_for(double reach_m) {
  int levels = 1;
  while (levels < kMostLevels && (1 << levels) * kCorrelationCellM <= 2.0 * reach_m) ++levels;
  return levels;
}

std::vector<Point2> evenly(std::span<const Point2> ends) {
  std::vector<Point2> some;
  const std::size_t each = ends.size() / kMostCorrelated + 1;
  for (std::size_t i = 0; i < ends.size(); i += each) some.push_back(ends[i]);
  return some;
}

/// Finds a cell again by a table of places that are open (Knuth): a node a cell, as std::unordered_map has, costs
/// thrice.
class PlacesOfCells {
 public:
  /// At most so many cells.
  explicit PlacesOfCells(std::size_t cells) : slots_(std::bit_ceil(2 * cells + 1)) {}
  /// Of a cell that has come before its place; else `place` from now on.
  std::uint32_t place_of(std::uint64_t cell, std::uint32_t place) {
    auto slot = static_cast<std::size_t>((cell * 0x9E3779B97F4A7C15U) >> 32U);
    for (;; ++slot) {
      Slot& at = slots_[slot & (slots_.size() - 1)];
      if (at.place_plus_1 == 0) at = {cell, place + 1};
      if (at.cell == cell) return at.place_plus_1 - 1;
    }
  }

 private:
  struct Slot {
    std::uint64_t cell = 0;
    std::uint32_t place_plus_1 = 0;
  };
  std::vector<Slot> slots_;
};

/// Places near a scan's ends, in squares: no other surface counts for the scan there.
class NearEnds {
 public:
  NearEnds(std::span<const Point2> ends, const Pose2& submap_from_scan) {
    const PointsInMap in_submap{submap_from_scan};
    std::vector<Point2> placed;
    placed.reserve(ends.size());
    for (const Point2& end : ends) placed.push_back(in_submap(end));
    const SearchWindow around = window_around(placed);
    const double margin_m = (kNearSquares + 1) * kNearSquareM;
    const int side = rounded_down(2.0 * (around.position_m + margin_m) / kNearSquareM) + 1;
    squares_ = {side, side, kNearSquareM, around.centre.position() - Point2::Constant(around.position_m + margin_m)};
    is_near_.resize(squares_.cell_count(), 0);
    std::vector<char> is_marked(squares_.cell_count(), 0);
    for (const Point2& end : placed) {
      const Cell cell = squares_.cell_at(end);
      if (std::exchange(is_marked[squares_.index_of(cell)], 1) != 0) continue;
      for (int row = cell.row - kNearSquares; row <= cell.row + kNearSquares; ++row) {
        for (int column = cell.column - kNearSquares; column <= cell.column + kNearSquares; ++column) {
          is_near_[squares_.index_of({column, row})] = 1;
        }
      }
    }
  }
  [[nodiscard]] bool has(const Point2& place) const {
    const Cell cell = squares_.cell_at(place);
    return squares_.contains(cell) && is_near_[squares_.index_of(cell)] != 0;
  }

 private:
  static constexpr double kNearSquareM = 0.5;
  static constexpr int kNearSquares = 2;  // a metre: the lattice is off by a cell, where ends are far by some
  GridGeometry squares_;
  std::vector<char> is_near_;
};

/// Of each table cell near the ends the point next to its middle: passes over the same surface leave dozens.
std::vector<mapping::registration::SurfacePoint> one_a_cell(
    const std::vector<mapping::registration::SurfacePoint>& points, const NearEnds& near) {
  PlacesOfCells places{points.size()};
  std::vector<mapping::registration::SurfacePoint> kept;
  std::vector<double> off2;
  for (const mapping::registration::SurfacePoint& point : points) {
    if (!near.has(point.position)) continue;
    const Point2 in_table = point.position / kTableCellM;
    const Cell cell{rounded_down(in_table.x()), rounded_down(in_table.y())};
    const double off = (in_table - Point2{cell.column + 0.5, cell.row + 0.5}).squaredNorm();
    const auto word = [](int at) { return static_cast<std::uint32_t>(at); };
    const std::uint64_t key = std::uint64_t{word(cell.column)} << 32U | word(cell.row);
    const std::uint32_t place = places.place_of(key, static_cast<std::uint32_t>(kept.size()));
    if (place == kept.size()) {
      kept.push_back(point);
      off2.push_back(off);
    } else if (off < off2[place]) {
      kept[place] = point;
      off2[place] = off;
    }
  }
  return kept;
}

PoseCovariance covariance_of(const Eigen::Matrix3d& by_ends, const Eigen::Matrix3d& known,
                             const SubmapMatchParams& params) {
  const double unobserved_m2 = kUnobservedM * kUnobservedM;
  const Eigen::Matrix3d floor =
      Eigen::Vector3d{1.0 / unobserved_m2, 1.0 / unobserved_m2, 1.0 / (kUnobservedRad * kUnobservedRad)}.asDiagonal();
  const Eigen::Vector3d inner{params.inner_deviation_m, params.inner_deviation_m, params.inner_deviation_rad};
  const Eigen::Matrix3d bent = inner.cwiseAbs2().asDiagonal();
  return (kIndependentShare * by_ends + known + floor).inverse() + bent;
}

}  // namespace

SearchWindow window_of(const Pose2& expected, const PoseCovariance& unsure) {
  return {expected, std::min(kMostWindowM, kDeviations * widest_deviation_m(unsure)),
          std::min(std::numbers::pi, kDeviations * std::sqrt(unsure(2, 2)))};
}

SubmapMatcher::SubmapMatcher(Submap submap, double reach_m)
    : everywhere_{window_around(submap.ends)},
      field_{submap.ends, kCorrelationCellM, levels_for(reach_m)},
      points_{std::move(submap.surface)} {}

std::optional<SubmapMatch> SubmapMatcher::match(std::span<const Point2> ends, double range_deviation_m,
                                                const SearchWindow& window,
                                                const mapping::registration::PoseBelief& known,
                                                const SubmapMatchParams& params) const {
  const std::vector<Point2> some = evenly(ends);
  auto found = best_match(field_, some, window, params.least_score, params.ambiguous_share);
  if (!found || found->elsewhere > 0.0) return std::nullopt;
  // Along a corridor all poses score alike: then the wheels know better than the best of them.
  if (!known.information.isZero() &&
      best_match(field_, some, {window.centre, 0.0, 0.0}, kFlatShare * found->score, 1.0)) {
    found->field_from_scan = window.centre;
    found->is_at_rim = false;
  }
  const mapping::registration::NearestSurface surface{one_a_cell(points_, {ends, found->field_from_scan}), kTableCellM,
                                                      kReachM};
  // Ends share errors: what was known before weighs as much more.
  const mapping::registration::Registration refined = mapping::registration::registration(
      ends, surface, found->field_from_scan, {known.pose, known.information / kIndependentShare},
      {.first_reach_m = kReachM, .last_reach_m = kLastReachM, .point_deviation_m = range_deviation_m});
  const Pose2 correction = motion_between(found->field_from_scan, refined.reference_from_moving);
  const bool fits = refined.settled &&
                    static_cast<double>(refined.paired) >= params.least_paired * static_cast<double>(ends.size()) &&
                    refined.deviation_m <= params.most_deviation_m &&
                    correction.position().norm() <= kMostCorrectionM &&
                    std::abs(correction.theta) <= kMostCorrectionRad;
  if (!fits) return std::nullopt;
  return SubmapMatch{refined.reference_from_moving, covariance_of(refined.information, known.information, params),
                     found->score, found->is_at_rim};
}

}  // namespace deltamap::surveying::slam
