// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/overlay_score.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::mapping::merge {
namespace {

constexpr std::uint8_t kFreeLabel = 1;
constexpr std::uint8_t kOccupiedLabel = 2;
constexpr std::uint8_t kNearContour = 4;

std::vector<PointInCells> every(const std::vector<PointInCells>& points, std::size_t stride) {
  std::vector<PointInCells> left;
  left.reserve(points.size() / stride + 1);
  for (std::size_t i = 0; i < points.size(); i += stride) left.push_back(points[i]);
  return left;
}

double ratio(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

}  // namespace

std::vector<Cell> contour_cells(const OccupancyGrid& map) {
  std::vector<Cell> contour;
  for (int row = 0; row < map.height(); ++row) {
    for (int column = 0; column < map.width(); ++column) {
      if (map[{column, row}] != CellState::kOccupied) continue;
      if (map.at({column + 1, row}) == CellState::kFree || map.at({column - 1, row}) == CellState::kFree ||
          map.at({column, row + 1}) == CellState::kFree || map.at({column, row - 1}) == CellState::kFree) {
        contour.push_back({column, row});
      }
    }
  }
  return contour;
}

LocalCells::LocalCells(const OccupancyGrid& local) {
  const std::vector<Cell> contour = contour_cells(local);
  Point2 middle{0.5 * local.width(), 0.5 * local.height()};
  if (!contour.empty()) {
    middle.setZero();
    for (const Cell& cell : contour) middle += Point2{cell.column + 0.5, cell.row + 0.5};
    middle /= static_cast<double>(contour.size());
  }
  middle_in_local_ = local.geometry().origin + local.resolution_m() * middle;
  const auto about_middle = [&](Cell cell) {
    return PointInCells{static_cast<float>(cell.column + 0.5 - middle.x()),
                        static_cast<float>(cell.row + 0.5 - middle.y())};
  };
  for (const Cell& cell : contour) contour_.push_back(about_middle(cell));
  for (std::size_t i = 0; i < local.cells().size(); ++i) {
    if (local.cells()[i] == CellState::kUnknown) continue;
    (local.cells()[i] == CellState::kOccupied ? occupied_ : free_).push_back(about_middle(local.geometry().cell_of(i)));
  }
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

OverlayMap::OverlayMap(const OccupancyGrid& map)
    : width_{map.width()}, height_{map.height()}, labels_(map.geometry().cell_count(), 0) {
  for (int row = 0; row < height_; ++row) {
    for (int column = 0; column < width_; ++column) {
      const std::size_t index = map.geometry().index_of({column, row});
      const CellState state = map.cells()[index];
      if (state == CellState::kFree) labels_[index] |= kFreeLabel;
      if (state == CellState::kOccupied) labels_[index] |= kOccupiedLabel;
    }
  }
  for (const Cell& cell : contour_cells(map)) {
    for (int y = std::max(0, cell.row - 1); y <= std::min(height_ - 1, cell.row + 1); ++y) {
      for (int x = std::max(0, cell.column - 1); x <= std::min(width_ - 1, cell.column + 1); ++x) {
        labels_[map.geometry().index_of({x, y})] |= kNearContour;
      }
    }
  }
}

std::uint8_t OverlayMap::label(float column, float row) const {
  // Truncation is floor for what lies in the map; what lies left of it by less than a cell is caught by the sign.
  if (!(column >= 0.0F && row >= 0.0F)) return 0;
  const int x = static_cast<int>(column);
  const int y = static_cast<int>(row);
  if (x >= width_ || y >= height_) return 0;
  return labels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
}

OverlayMap::Counts OverlayMap::counts(const std::vector<PointInCells>& points, const CellMotion& motion) const {
  const auto c = static_cast<float>(std::cos(motion.turn_rad));
  const auto s = static_cast<float>(std::sin(motion.turn_rad));
  const auto tx = static_cast<float>(motion.column);
  const auto ty = static_cast<float>(motion.row);
  Counts counts;
  for (const PointInCells& point : points) {
    const std::uint8_t there = label(c * point.x - s * point.y + tx, s * point.x + c * point.y + ty);
    counts.on_free += there & kFreeLabel;
    counts.on_occupied += (there & kOccupiedLabel) / kOccupiedLabel;
    counts.near_contour += (there & kNearContour) / kNearContour;
    counts.near_or_known += there != 0 ? 1U : 0U;
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
  score.agreeing = occupied_weight * occupied.on_occupied + free_weight * free.on_free;
  score.disagreeing = occupied_weight * occupied.on_free + free_weight * free.on_occupied;
  score.surface_found = ratio(contour.near_contour, static_cast<double>(local.contour().size()));
  score.surface_agreement = ratio(contour.near_contour, contour.near_or_known);
  score.overlap =
      ratio(score.agreeing + score.disagreeing, occupied_weight * static_cast<double>(local.occupied().size()) +
                                                    free_weight * static_cast<double>(local.free().size()));
  return score;
}

Pose2 map_from_local(const CellMotion& motion, const GridGeometry& map, const LocalCells& local) {
  const Point2 middle_in_map = map.origin + map.resolution_m * Point2{motion.column, motion.row};
  const Point2& middle = local.middle_in_local();
  return Pose2{middle_in_map.x(), middle_in_map.y(), wrapped_angle(motion.turn_rad)} *
         inverse(Pose2{middle.x(), middle.y(), 0.0});
}

CellMotion cell_motion(const Pose2& map_from_local, const GridGeometry& map, const LocalCells& local) {
  const Point2 middle = (map_from_local * local.middle_in_local() - map.origin) / map.resolution_m;
  return {map_from_local.theta, middle.x(), middle.y()};
}

}  // namespace deltamap::mapping::merge
