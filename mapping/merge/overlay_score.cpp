// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/overlay_score.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mapping/merge/thinned.hpp"

namespace deltamap::mapping::merge {
namespace {

constexpr std::uint8_t kFreeLabel = 1;
constexpr std::uint8_t kOccupiedLabel = 2;
constexpr std::uint8_t kNearContour = 4;

constexpr std::size_t kMostPacked = 0xFFFF;  // points before a field of 16 bits may overflow

/// What a label adds to the four counts, 16 bits each: one sum in place of four, and no branch.
constexpr std::array<std::uint64_t, 8> packed_counts() {
  std::array<std::uint64_t, 8> packed{};
  for (std::size_t label = 1; label < packed.size(); ++label) {
    packed[label] = ((label & kFreeLabel) != 0 ? 1ULL : 0ULL) | ((label & kOccupiedLabel) != 0 ? 1ULL << 16U : 0ULL) |
                    ((label & kNearContour) != 0 ? 1ULL << 32U : 0ULL) | 1ULL << 48U;
  }
  return packed;
}
constexpr std::array<std::uint64_t, 8> kPackedCounts = packed_counts();

double ratio(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

}  // namespace

Point2 middle_of(std::span<const Cell> contour, const OccupancyGrid& grid) {
  if (contour.empty()) return {0.5 * grid.width(), 0.5 * grid.height()};
  Point2 sum = Point2::Zero();
  for (const Cell& cell : contour) sum += Point2{cell.column + 0.5, cell.row + 0.5};
  return sum / static_cast<double>(contour.size());
}

LocalCells::LocalCells(const OccupancyGrid& local) : LocalCells{local, contour_cells(local)} {}

LocalCells::LocalCells(const OccupancyGrid& local, std::span<const Cell> contour) {
  const Point2 middle = middle_of(contour, local);
  middle_in_local_ = local.geometry().origin + local.resolution_m() * middle;
  const auto about_middle = [&](Cell cell) {
    return PointInCells{static_cast<float>(cell.column + 0.5 - middle.x()),
                        static_cast<float>(cell.row + 0.5 - middle.y())};
  };
  for (const Cell& cell : contour) contour_.push_back(about_middle(cell));
  for_each_known(local, [&](Cell cell, CellState state) {
    (state == CellState::kOccupied ? occupied_ : free_).push_back(about_middle(cell));
  });
}

LocalCells LocalCells::thinned(std::size_t most_cells) const {
  LocalCells left = *this;
  const std::size_t most_of_a_kind = std::max<std::size_t>(1, most_cells / 3);
  const std::size_t contour_stride = (contour_.size() + most_of_a_kind - 1) / most_of_a_kind;
  const std::size_t occupied_stride = (occupied_.size() + most_of_a_kind - 1) / most_of_a_kind;
  const std::size_t free_stride = (free_.size() + most_of_a_kind - 1) / most_of_a_kind;
  if (contour_stride > 1) left.contour_ = every(contour_, contour_stride);
  if (occupied_stride > 1) left.occupied_ = every(occupied_, occupied_stride);
  if (free_stride > 1) left.free_ = every(free_, free_stride);
  left.occupied_weight_ *= ratio(static_cast<double>(occupied_.size()), static_cast<double>(left.occupied_.size()));
  left.free_weight_ *= ratio(static_cast<double>(free_.size()), static_cast<double>(left.free_.size()));
  return left;
}

OverlayMap::OverlayMap(const OccupancyGrid& map) : OverlayMap{map, contour_cells(map)} {}

OverlayMap::OverlayMap(const OccupancyGrid& map, std::span<const Cell> contour)
    : width_{map.width() + 2},
      height_{map.height() + 2},
      labels_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0) {
  const auto index_of = [&](int column, int row) {
    return static_cast<std::size_t>(row + 1) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column + 1);
  };
  for (int row = 0; row < map.height(); ++row) {
    for (int column = 0; column < map.width(); ++column) {
      const CellState state = map[{column, row}];
      if (state == CellState::kFree) labels_[index_of(column, row)] |= kFreeLabel;
      if (state == CellState::kOccupied) labels_[index_of(column, row)] |= kOccupiedLabel;
    }
  }
  for (const Cell& cell : contour) {
    for (int y = std::max(0, cell.row - 1); y <= std::min(map.height() - 1, cell.row + 1); ++y) {
      for (int x = std::max(0, cell.column - 1); x <= std::min(map.width() - 1, cell.column + 1); ++x) {
        labels_[index_of(x, y)] |= kNearContour;
      }
    }
  }
}

OverlayMap::Counts OverlayMap::counts(std::span<const PointInCells> points, const CellMotion& motion) const {
  const auto c = static_cast<float>(std::cos(motion.turn_rad));
  const auto s = static_cast<float>(std::sin(motion.turn_rad));
  const auto tx = static_cast<float>(motion.column + 1.0);
  const auto ty = static_cast<float>(motion.row + 1.0);
  const auto width = static_cast<std::uint32_t>(width_);
  const auto height = static_cast<std::uint32_t>(height_);
  Counts counts;
  for (; !points.empty(); points = points.subspan(std::min(points.size(), kMostPacked))) {
    std::uint64_t packed = 0;
    for (const PointInCells& point : points.first(std::min(points.size(), kMostPacked))) {
      // Truncation is floor from the border on; what lies beyond it is negative and, unsigned, too large.
      const auto x = static_cast<std::uint32_t>(static_cast<std::int32_t>(c * point.x - s * point.y + tx));
      const auto y = static_cast<std::uint32_t>(static_cast<std::int32_t>(s * point.x + c * point.y + ty));
      const std::size_t index = x < width && y < height ? std::size_t{y} * width + x : 0;
      packed += kPackedCounts[labels_[index]];
    }
    counts.on_free += packed & kMostPacked;
    counts.on_occupied += packed >> 16U & kMostPacked;
    counts.near_contour += packed >> 32U & kMostPacked;
    counts.near_or_known += packed >> 48U;
  }
  return counts;
}

OverlayScore OverlayMap::score(const LocalCells& local, const CellMotion& motion) const {
  const Counts contour = counts(local.contour(), motion);
  const Counts occupied = counts(local.occupied(), motion);
  const Counts free = counts(local.free(), motion);
  const double occupied_weight = local.occupied_weight();
  const double free_weight = local.free_weight();
  OverlayScore score;
  score.agreeing =
      occupied_weight * static_cast<double>(occupied.on_occupied) + free_weight * static_cast<double>(free.on_free);
  score.disagreeing =
      occupied_weight * static_cast<double>(occupied.on_free) + free_weight * static_cast<double>(free.on_occupied);
  score.surface_found = ratio(static_cast<double>(contour.near_contour), static_cast<double>(local.contour().size()));
  score.surface_agreement =
      ratio(static_cast<double>(contour.near_contour), static_cast<double>(contour.near_or_known));
  score.overlap =
      ratio(score.agreeing + score.disagreeing, occupied_weight * static_cast<double>(local.occupied().size()) +
                                                    free_weight * static_cast<double>(local.free().size()));
  return score;
}

std::vector<PointInCells> about_centre(std::span<const Cell> contour, const OccupancyGrid& grid) {
  std::vector<PointInCells> points;
  for (const Cell& cell : contour) {
    points.push_back(
        {static_cast<float>(cell.column - 0.5 * grid.width()), static_cast<float>(cell.row - 0.5 * grid.height())});
  }
  return points;
}

Pose2 map_from_local(const CellMotion& motion, const GridGeometry& map, const Point2& middle_in_local) {
  const Point2 middle_in_map = map.origin + map.resolution_m * Point2{motion.column, motion.row};
  return Pose2{middle_in_map.x(), middle_in_map.y(), wrapped_angle(motion.turn_rad)} *
         inverse(Pose2{middle_in_local.x(), middle_in_local.y(), 0.0});
}

CellMotion cell_motion(const Pose2& map_from_local, const GridGeometry& map, const Point2& middle_in_local) {
  const Point2 middle = (map_from_local * middle_in_local - map.origin) / map.resolution_m;
  return {map_from_local.theta, middle.x(), middle.y()};
}

}  // namespace deltamap::mapping::merge
