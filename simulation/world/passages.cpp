// SPDX-License-Identifier: Apache-2.0
#include "simulation/world/passages.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace deltamap::simulation {
namespace {

constexpr double kCellSide_m = 0.2;

GridGeometry floor_geometry(const World& world) {
  const Bounds bounds = bounds_of(world);
  const Point2 size = bounds.high - bounds.low;
  return {static_cast<int>(size.x() / kCellSide_m) + 1, static_cast<int>(size.y() / kCellSide_m) + 1, kCellSide_m,
          bounds.low};
}

/// Distance from points to one shape; a box's turn is worked out once for all of them.
class DistanceTo {
 public:
  explicit DistanceTo(const Shape& shape) : shape_{shape}, box_{std::get_if<Box>(&shape)} {
    if (box_ != nullptr) {
      axis_ = {std::cos(box_->theta_rad), std::sin(box_->theta_rad)};
    }
  }
  [[nodiscard]] double operator()(const Point2& point) const {
    if (box_ == nullptr) return distance_between(point, shape_);
    const Point2 offset = point - box_->centre;
    const double along = std::abs(offset.dot(axis_)) - 0.5 * box_->width_m;
    const double across = std::abs(axis_.x() * offset.y() - axis_.y() * offset.x()) - 0.5 * box_->height_m;
    return std::hypot(std::max(0.0, along), std::max(0.0, across));
  }

 private:
  const Shape& shape_;
  const Box* box_;
  Point2 axis_{1.0, 0.0};
};

void block(const Shape& shape, double clearance_m, const GridGeometry& geometry, std::vector<bool>& blocked) {
  const DistanceTo distance_to{shape};
  const Bounds bounds = bounds_of({{{0, ObjectKind::kWall, shape}}});
  const Cell first = geometry.cell_at(bounds.low - Point2::Constant(clearance_m));
  const Cell last = geometry.cell_at(bounds.high + Point2::Constant(clearance_m));
  for (int row = first.row; row <= last.row; ++row) {
    for (int column = first.column; column <= last.column; ++column) {
      const Cell cell{column, row};
      if (!geometry.contains(cell) || blocked[geometry.index_of(cell)]) continue;
      if (distance_to(geometry.centre_of(cell)) <= clearance_m) blocked[geometry.index_of(cell)] = true;
    }
  }
}

std::vector<bool> blocked_floor(const World& world, double clearance_m, const GridGeometry& geometry) {
  std::vector<bool> blocked(geometry.cell_count(), false);
  for (const Object& object : world.objects) {
    if (!std::holds_alternative<Polyline>(object.shape)) {
      block(object.shape, clearance_m, geometry, blocked);
      continue;
    }
    for (const Segment& piece : segments_of(object.shape)) {
      block(Polyline{{piece.from, piece.to}}, clearance_m, geometry, blocked);
    }
  }
  return blocked;
}

/// Whether one can look from `from` to places near by: nothing that stands within `within_m` lies between.
class NearSight {
 public:
  NearSight(const World& world, const Point2& from, double within_m) : from_{from} {
    for (const Object& object : world.objects) {
      for (const Segment& piece : segments_of(object.shape)) {
        if (distance_between(from, piece) <= within_m) pieces_.push_back(piece);
      }
    }
  }
  [[nodiscard]] bool reaches(const Point2& to) const {
    return std::none_of(pieces_.begin(), pieces_.end(), [&](const Segment& piece) {
      return distance_between(Segment{from_, to}, piece) == 0.0;
    });
  }

 private:
  Point2 from_;
  std::vector<Segment> pieces_;
};

}  // namespace

bool ReachableFloor::contains(const Point2& point) const {
  const Cell cell = geometry.cell_at(point);
  return geometry.contains(cell) && reached[geometry.index_of(cell)];
}

ReachableFloor reachable_floor(const World& world, const Point2& from, double clearance_m) {
  const GridGeometry geometry = floor_geometry(world);
  std::vector<bool> closed = blocked_floor(world, clearance_m, geometry);
  ReachableFloor floor{geometry, std::vector<bool>(geometry.cell_count(), false)};
  std::vector<Cell> open;
  const auto reach = [&](Cell cell) {
    if (!geometry.contains(cell) || closed[geometry.index_of(cell)]) return;
    closed[geometry.index_of(cell)] = true;
    floor.reached[geometry.index_of(cell)] = true;
    open.push_back(cell);
  };
  // Whoever asks may stand closer to a surface than the clearance: begin with all floor a step away, but not behind a
  // wall.
  const int steps = static_cast<int>(std::ceil(clearance_m / kCellSide_m)) + 1;
  const Cell start = geometry.cell_at(from);
  const NearSight sight{world, from, 2.0 * steps * kCellSide_m};
  for (int row = -steps; row <= steps; ++row) {
    for (int column = -steps; column <= steps; ++column) {
      const Cell cell{start.column + column, start.row + row};
      if (sight.reaches(geometry.centre_of(cell))) reach(cell);
    }
  }
  while (!open.empty()) {
    const Cell cell = open.back();
    open.pop_back();
    for (const Cell next : {Cell{cell.column + 1, cell.row}, Cell{cell.column - 1, cell.row},
                            Cell{cell.column, cell.row + 1}, Cell{cell.column, cell.row - 1}}) {
      reach(next);
    }
  }
  return floor;
}

double share_still_reached(const ReachableFloor& floor, const ReachableFloor& other) {
  assert(floor.geometry == other.geometry && "both floors lie in the same cells");
  std::size_t all = 0;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < floor.reached.size(); ++i) {
    if (!floor.reached[i]) continue;
    ++all;
    if (other.reached[i]) ++kept;
  }
  return all == 0 ? 1.0 : static_cast<double>(kept) / static_cast<double>(all);
}

}  // namespace deltamap::simulation
