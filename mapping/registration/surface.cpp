// SPDX-License-Identifier: Apache-2.0
// Why normals: a place on a straight surface tells its distance alone, not where along the surface it is. The places
// around it give the direction; where they make no line (a corner, a clump) there is no normal and the place does not
// count.
#include "mapping/registration/surface.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/grid/grid_contour.hpp"

namespace deltamap::mapping::registration {
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
  const double spread = std::sqrt((xx - yy) * (xx - yy) + 4.0 * xy * xy);
  const double larger = 0.5 * (xx + yy + spread);
  const double smaller = 0.5 * (xx + yy - spread);
  if (larger <= 0.0 || smaller > kMostRoundness * larger) return std::nullopt;
  // The line runs at half the angle whose cosine is (xx - yy) / spread and whose sine is 2 xy / spread.
  const double cosine2 = 0.5 * (1.0 + (xx - yy) / spread);
  const double sine2 = 0.5 * (1.0 - (xx - yy) / spread);
  return Point2{-std::copysign(std::sqrt(std::max(0.0, sine2)), xy), std::sqrt(std::max(0.0, cosine2))};
}

/// Of the line through an end and its neighbours.
std::optional<Point2> normal_at(std::span<const Point2> ordered_ends, std::size_t i) {
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
  return normal_of(sums);
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
    ends.emplace_back(tracked.rays[i].end.cast<double>());
  }
  return ends;
}

std::vector<SurfacePoint> surface_of(std::span<const Point2> ordered_ends) {
  std::vector<SurfacePoint> surface;
  surface.reserve(ordered_ends.size());
  for (std::size_t i = 0; i < ordered_ends.size(); ++i) {
    if (const auto normal = normal_at(ordered_ends, i)) surface.push_back({ordered_ends[i], *normal});
  }
  return surface;
}

std::vector<Eigen::Vector2f> normals_of(std::span<const Point2> ordered_ends) {
  std::vector<Eigen::Vector2f> normals;
  normals.reserve(ordered_ends.size());
  for (std::size_t i = 0; i < ordered_ends.size(); ++i) {
    normals.emplace_back(normal_at(ordered_ends, i).value_or(Point2::Zero()).cast<float>());
  }
  return normals;
}

std::vector<SurfacePoint> contour_of(const OccupancyGrid& map, const CellBox& box) {
  return contour_of(map, box, [](Cell) { return true; });
}

std::vector<SurfacePoint> contour_of(const OccupancyGrid& map, const CellBox& box,
                                     const std::function<bool(Cell)>& is_wanted) {
  constexpr int kAround = 2;  // cells; the line is laid through the contour in 5 × 5 cells
  const CellBox wide = grown(box, kAround, map.geometry());
  if (wide.empty()) return {};
  const auto width = static_cast<std::size_t>(wide.width());
  std::vector<char> is_on_contour(wide.cell_count(), 0);
  const std::vector<Cell> contour = contour_cells(map, wide);
  for (const Cell& cell : contour) is_on_contour[wide.index_of(cell)] = 1;
  std::vector<SurfacePoint> surface;
  for (const Cell& cell : contour) {
    if (!is_wanted(cell)) continue;
    PlaceSums sums;
    const int first = std::max(cell.column - kAround, wide.first.column);
    const int last = std::min(cell.column + kAround, wide.last.column - 1);
    for (int y = std::max(cell.row - kAround, wide.first.row); y <= std::min(cell.row + kAround, wide.last.row - 1);
         ++y) {
      const char* const marks = is_on_contour.data() + static_cast<std::size_t>(y - wide.first.row) * width;
      for (int x = first; x <= last; ++x) {
        if (marks[x - wide.first.column] != 0) sums.add(Point2{x - cell.column, y - cell.row});
      }
    }
    if (const auto normal = normal_of(sums)) surface.push_back({map.geometry().centre_of(cell), *normal});
  }
  return surface;
}

NearestSurface::NearestSurface(std::vector<SurfacePoint> points, double table_cell_m, double reach_m)
    : points_{std::move(points)},
      table_{table_around(points_, table_cell_m, reach_m)},
      nearest_(table_.cell_count(), -1),
      distance2_(table_.cell_count(), std::nextafter(static_cast<float>(reach_m * reach_m), 1e9F)),
      reach2_{static_cast<float>(reach_m * reach_m)},
      cells_per_metre_{static_cast<float>(1.0 / table_cell_m)},
      low_x_{static_cast<float>(table_.origin.x())},
      low_y_{static_cast<float>(table_.origin.y())} {
  const int reach_cells = static_cast<int>(std::ceil(reach_m / table_cell_m));
  std::vector<double> across2(2 * static_cast<std::size_t>(reach_cells) + 1);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point2& position = points_[i].position;
    const Cell middle = table_.cell_at(position);
    const int first = std::max(0, middle.column - reach_cells);
    const int last = std::min(table_.width - 1, middle.column + reach_cells);
    for (int column = first; column <= last; ++column) {
      const double dx = table_.centre_of({column, 0}).x() - position.x();
      across2[static_cast<std::size_t>(column - first)] = dx * dx;
    }
    for (int row = std::max(0, middle.row - reach_cells); row <= std::min(table_.height - 1, middle.row + reach_cells);
         ++row) {
      const double dy = table_.centre_of({0, row}).y() - position.y();
      const double up2 = dy * dy;
      const std::size_t start = table_.index_of({first, row});
      for (std::size_t k = 0; k <= static_cast<std::size_t>(last - first); ++k) {
        const auto d2 = static_cast<float>(across2[k] + up2);
        if (d2 >= distance2_[start + k]) continue;
        distance2_[start + k] = d2;
        nearest_[start + k] = static_cast<std::int32_t>(i);
      }
    }
  }
}

}  // namespace deltamap::mapping::registration
