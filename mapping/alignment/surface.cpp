// SPDX-License-Identifier: Apache-2.0
#include "mapping/alignment/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace deltamap::mapping::alignment {
namespace {

constexpr double kMostRoundness =
    0.1;  // smaller over larger variance of the neighbours: a line, not a corner or a clump
constexpr std::size_t kNeighbours = 3;  // ray ends on each side
constexpr double kMostGap_m = 0.25;     // between neighbours on one surface
constexpr double kMostGapPerRange = 0.06;

/// Sums of the places that a line is laid through.
struct PlaceSums {
  double count = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  void add(const Point2& place) {
    count += 1.0, x += place.x(), y += place.y();
    xx += place.x() * place.x(), xy += place.x() * place.y(), yy += place.y() * place.y();
  }
};

/// The normal of the line through the places; none for fewer than three or a shape that is no line.
std::optional<Point2> normal_of(const PlaceSums& sums) {
  if (sums.count < 3.0) return std::nullopt;
  const double mean_x = sums.x / sums.count;
  const double mean_y = sums.y / sums.count;
  const double xx = sums.xx / sums.count - mean_x * mean_x;
  const double xy = sums.xy / sums.count - mean_x * mean_y;
  const double yy = sums.yy / sums.count - mean_y * mean_y;
  const double spread = std::hypot(xx - yy, 2.0 * xy);
  const double larger = 0.5 * (xx + yy + spread);
  const double smaller = 0.5 * (xx + yy - spread);
  if (larger <= 0.0 || smaller > kMostRoundness * larger) return std::nullopt;
  const double along_rad = 0.5 * std::atan2(2.0 * xy, xx - yy);
  return Point2{-std::sin(along_rad), std::cos(along_rad)};
}

bool is_contour(const OccupancyGrid& map, Cell cell) {
  if (map[cell] != CellState::kOccupied) return false;
  return map.at({cell.column + 1, cell.row}) == CellState::kFree ||
         map.at({cell.column - 1, cell.row}) == CellState::kFree ||
         map.at({cell.column, cell.row + 1}) == CellState::kFree ||
         map.at({cell.column, cell.row - 1}) == CellState::kFree;
}

GridGeometry table_around(std::span<const SurfacePoint> points, double cell_m, double reach_m) {
  if (points.empty()) return {0, 0, cell_m, {0.0, 0.0}};
  Point2 low = points.front().position;
  Point2 high = low;
  for (const SurfacePoint& point : points) {
    low = low.cwiseMin(point.position);
    high = high.cwiseMax(point.position);
  }
  low.array() -= reach_m;
  high.array() += reach_m;
  const Point2 size_m = high - low;
  return {static_cast<int>(std::ceil(size_m.x() / cell_m)) + 1, static_cast<int>(std::ceil(size_m.y() / cell_m)) + 1,
          cell_m, low};
}

}  // namespace

std::vector<Point2> ray_ends(const TrackedScan& tracked, double longest_m) {
  std::vector<Point2> ends;
  ends.reserve(tracked.rays.size());
  const std::size_t count = std::min(tracked.rays.size(), tracked.scan.beams.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Beam& beam = tracked.scan.beams[i];
    if (beam.kind != BeamKind::kRange || static_cast<double>(beam.range_m) > longest_m) continue;
    ends.push_back(tracked.rays[i].end.cast<double>());
  }
  return ends;
}

std::vector<SurfacePoint> surface_of(std::span<const Point2> ordered_ends) {
  std::vector<SurfacePoint> surface;
  surface.reserve(ordered_ends.size());
  for (std::size_t i = 0; i < ordered_ends.size(); ++i) {
    const Point2& here = ordered_ends[i];
    const double most_gap_m = std::max(kMostGap_m, kMostGapPerRange * here.norm());
    PlaceSums sums;
    sums.add(Point2::Zero());
    const auto adjoins = [&](std::size_t a, std::size_t b) {
      return (ordered_ends[a] - ordered_ends[b]).norm() <= most_gap_m;
    };
    for (std::size_t k = 1; k <= kNeighbours && i >= k && adjoins(i - k, i - k + 1); ++k) {
      sums.add(ordered_ends[i - k] - here);
    }
    for (std::size_t k = 1; k <= kNeighbours && i + k < ordered_ends.size() && adjoins(i + k, i + k - 1); ++k) {
      sums.add(ordered_ends[i + k] - here);
    }
    if (const auto normal = normal_of(sums)) surface.push_back({here, *normal});
  }
  return surface;
}

std::vector<SurfacePoint> contour_of(const OccupancyGrid& map, const CellBox& box) {
  constexpr int kAround = 2;  // cells; the line is laid through the contour in 5 × 5 cells
  const CellBox wide = grown(box, kAround, map.geometry());
  if (wide.empty()) return {};
  const int width = wide.width();
  std::vector<char> contour(static_cast<std::size_t>(width) * static_cast<std::size_t>(wide.height()), 0);
  const auto index_of = [&](int column, int row) {
    return static_cast<std::size_t>(row - wide.first.row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column - wide.first.column);
  };
  for (int row = wide.first.row; row < wide.last.row; ++row) {
    for (int column = wide.first.column; column < wide.last.column; ++column) {
      contour[index_of(column, row)] = is_contour(map, {column, row}) ? 1 : 0;
    }
  }
  std::vector<SurfacePoint> surface;
  for (int row = wide.first.row; row < wide.last.row; ++row) {
    for (int column = wide.first.column; column < wide.last.column; ++column) {
      if (contour[index_of(column, row)] == 0) continue;
      PlaceSums sums;
      for (int y = std::max(row - kAround, wide.first.row); y <= std::min(row + kAround, wide.last.row - 1); ++y) {
        for (int x = std::max(column - kAround, wide.first.column);
             x <= std::min(column + kAround, wide.last.column - 1); ++x) {
          if (contour[index_of(x, y)] != 0) sums.add(Point2{x - column, y - row});
        }
      }
      if (const auto normal = normal_of(sums)) surface.push_back({map.geometry().centre_of({column, row}), *normal});
    }
  }
  return surface;
}

NearestSurface::NearestSurface(std::vector<SurfacePoint> points, double table_cell_m, double reach_m)
    : points_{std::move(points)}, table_{table_around(points_, table_cell_m, reach_m)} {
  nearest_.assign(table_.cell_count(), -1);
  std::vector<float> distance2(table_.cell_count(), std::numeric_limits<float>::max());
  const int reach_cells = static_cast<int>(std::ceil(reach_m / table_cell_m));
  const auto reach2 = static_cast<float>(reach_m * reach_m);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point2& position = points_[i].position;
    const Cell middle = table_.cell_at(position);
    for (int row = std::max(0, middle.row - reach_cells); row <= std::min(table_.height - 1, middle.row + reach_cells);
         ++row) {
      for (int column = std::max(0, middle.column - reach_cells);
           column <= std::min(table_.width - 1, middle.column + reach_cells); ++column) {
        const std::size_t index = table_.index_of({column, row});
        const auto d2 = static_cast<float>((table_.centre_of({column, row}) - position).squaredNorm());
        if (d2 > reach2 || d2 >= distance2[index]) continue;
        distance2[index] = d2;
        nearest_[index] = static_cast<std::int32_t>(i);
      }
    }
  }
}

}  // namespace deltamap::mapping::alignment
