// SPDX-License-Identifier: Apache-2.0
// Why surfaces alone, and twice: legs, leaves and people who walk by leave ends that the next pass does not find, and
// no map is false for that.
#include "surveying/quality/seen_walls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/geometry/points_in_map.hpp"
#include "core/grid/grid_ray.hpp"
#include "mapping/registration/surface.hpp"

namespace deltamap::surveying::quality {
namespace {

constexpr std::uint16_t kFewestScans = 2;  // that ended in a cell

struct SeenCell {
  Cell cell;
  SeenWalls::Wall wall;
};

GridGeometry geometry_around(std::span<const PlacedScan> scans) {
  if (scans.empty()) return {0, 0, kWallCellM, {0.0, 0.0}};
  Point2 low = scans.front().map_from_robot.position();
  Point2 high = low;
  for (const PlacedScan& scan : scans) {
    low = low.cwiseMin(scan.map_from_robot.position());
    high = high.cwiseMax(scan.map_from_robot.position());
  }
  const double margin_m = kLongestSeenM + 1.0;
  const auto cells = [&](double metres) { return static_cast<int>(std::ceil((metres + 2.0 * margin_m) / kWallCellM)); };
  return {cells(high.x() - low.x()), cells(high.y() - low.y()), kWallCellM, {low.x() - margin_m, low.y() - margin_m}};
}

/// What one pass has seen in the part of the grid around it.
class PassView {
 public:
  PassView(std::span<const PlacedScan> scans, const GridGeometry& grid) : grid_{grid} {
    const GridGeometry around = geometry_around(scans);
    first_ = grid.cell_at(around.origin);
    columns_ = around.width + 1;
    cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(around.height + 1));
    for (std::size_t k = 0; k < scans.size(); ++k) add(scans[k], static_cast<std::uint16_t>(k + 1));
  }

  void collect(std::uint32_t pass, std::vector<SeenCell>& walls) const {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (cells_[i].surface == 0 || cells_[i].hits < cells_[i].crossings) continue;
      const Surface& of = surfaces_[cells_[i].surface - 1U];
      if (of.scans < kFewestScans) continue;
      const int row = static_cast<int>(i) / columns_;
      const float angle = 0.5F * std::atan2(of.sine2, of.cosine2);
      const Eigen::Vector2f either{std::cos(angle), std::sin(angle)};
      walls.push_back({{first_.column + static_cast<int>(i) - row * columns_, first_.row + row},
                       {pass, either.dot(of.to_laser) < 0.0F ? Eigen::Vector2f{-either} : either}});
    }
  }

 private:
  struct Counts {
    std::uint16_t hits = 0;
    std::uint16_t crossings = 0;
    std::uint16_t surface = 0;  // in surfaces_, counted from 1; 0: none
  };
  /// Of the few cells in which ends lie on one: a pass has far fewer ends than 65 536.
  struct Surface {
    std::uint16_t last_scan = 0;  // counted from 1
    std::uint16_t scans = 0;
    float cosine2 = 0.0F;  // of twice the normal's direction, so that either side is the same
    float sine2 = 0.0F;
    Eigen::Vector2f to_laser{0.0F, 0.0F};  // summed directions
  };

  Counts* at(Cell cell) {
    const int column = cell.column - first_.column;
    const int row = cell.row - first_.row;
    const std::size_t place =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
    return column < 0 || row < 0 || column >= columns_ || place >= cells_.size() ? nullptr : &cells_[place];
  }

  Surface* surface_in(Counts& cell) {
    if (cell.surface == 0 && surfaces_.size() < std::numeric_limits<std::uint16_t>::max()) {
      surfaces_.emplace_back();
      cell.surface = static_cast<std::uint16_t>(surfaces_.size());
    }
    return cell.surface == 0 ? nullptr : &surfaces_[cell.surface - 1U];
  }

  void add(const PlacedScan& scan, std::uint16_t number) {
    const PointsInMap in_map{scan.map_from_robot};
    for (const auto& point : mapping::registration::surface_of(scan.scan->ends(kLongestSeenM))) {
      Counts* const cell = at(grid_.cell_at(in_map(point.position)));
      if (cell == nullptr) continue;
      Surface* const of = surface_in(*cell);
      if (of == nullptr) continue;
      const double angle2 = 2.0 * (std::atan2(point.normal.y(), point.normal.x()) + scan.map_from_robot.theta);
      of->cosine2 += static_cast<float>(std::cos(angle2));
      of->sine2 += static_cast<float>(std::sin(angle2));
      of->to_laser += (scan.map_from_robot.position() - in_map(point.position)).normalized().cast<float>();
      of->scans = static_cast<std::uint16_t>(of->scans + (of->last_scan == number ? 0 : 1));
      of->last_scan = number;
    }
    const TrackedScan tracked = scan.scan->tracked();
    for (std::size_t i = 0; i < tracked.rays.size(); ++i) {
      if (tracked.scan.beams[i].kind == BeamKind::kRange) add_beam(in_map, tracked.rays[i]);
    }
  }

  void add_beam(const PointsInMap& in_map, const RayInRobot& ray) {
    const Point2 origin = in_map(ray.origin);
    const Point2 end = in_map(ray.end);
    const double length_m = (end - origin).norm();
    const Cell last = grid_.cell_at(end);
    walk_ray(grid_, origin, end, [&](Cell cell, double entered_m) {
      if (Counts* const of = at(cell)) ++(cell == last && length_m <= kLongestSeenM ? of->hits : of->crossings);
      return entered_m <= kLongestSeenM;
    });
  }

  const GridGeometry& grid_;
  Cell first_;
  int columns_ = 0;
  std::vector<Counts> cells_;
  std::vector<Surface> surfaces_;
};

}  // namespace

SeenWalls::SeenWalls(std::span<const PlacedScan> scans, std::span<const Pass> passes)
    : geometry_{geometry_around(scans)}, place_{geometry_.width, geometry_.height, 0U} {
  std::vector<SeenCell> seen;
  for (std::uint32_t i = 0; i < passes.size(); ++i) {
    PassView{scans.subspan(passes[i].first, passes[i].last - passes[i].first + 1), geometry_}.collect(i, seen);
  }
  std::stable_sort(seen.begin(), seen.end(), [](const SeenCell& a, const SeenCell& b) {
    return std::tie(a.cell.row, a.cell.column) < std::tie(b.cell.row, b.cell.column);
  });
  walls_.reserve(seen.size());
  for (const SeenCell& one : seen) {
    if (!geometry_.contains(one.cell)) continue;
    if (place_[one.cell] == 0) {
      begins_.push_back(static_cast<std::uint32_t>(walls_.size()));
      place_.set(one.cell, static_cast<std::uint32_t>(begins_.size()));
    }
    walls_.push_back(one.wall);
  }
  begins_.push_back(static_cast<std::uint32_t>(walls_.size()));
}

}  // namespace deltamap::surveying::quality
