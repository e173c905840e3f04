// SPDX-License-Identifier: Apache-2.0
#include "simulation/world/ray_caster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/grid/grid_ray.hpp"

namespace deltamap::simulation {
namespace {

constexpr double kBucketSide_m = 1.0;
constexpr double kNever = std::numeric_limits<double>::infinity();

double cross(const Point2& a, const Point2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Distance along the unit direction to the segment; infinite where it is not met.
inline double range_to(const Segment& segment, const Point2& from, const Point2& direction) {
  const Point2 along = segment.to - segment.from;
  const double sine = cross(direction, along);
  if (sine == 0.0) return kNever;  // parallel: a surface seen edge-on has no face
  const Point2 start = segment.from - from;
  const double range_m = cross(start, along) / sine;
  const double share = cross(start, direction) / sine;
  return range_m >= 0.0 && share >= 0.0 && share <= 1.0 ? range_m : kNever;
}

inline double range_to(const Circle& circle, const Point2& from, const Point2& direction) {
  const Point2 to_centre = circle.centre - from;
  const double nearest = to_centre.dot(direction);
  const double half_chord2 = circle.radius_m * circle.radius_m - (to_centre.squaredNorm() - nearest * nearest);
  if (half_chord2 < 0.0) return kNever;
  const double half_chord = std::sqrt(half_chord2);
  if (nearest - half_chord >= 0.0) return nearest - half_chord;
  return nearest + half_chord >= 0.0 ? nearest + half_chord : kNever;  // from inside
}

bool is_thin(const Shape& shape) {
  if (const auto* circle = std::get_if<Circle>(&shape)) return 2.0 * circle->radius_m < kThin_m;
  const auto* box = std::get_if<Box>(&shape);
  return box != nullptr && std::hypot(box->width_m, box->height_m) < kThin_m;
}

Point2 nearest_point(const Segment& segment, const Point2& point) {
  const Point2 along = segment.to - segment.from;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0.0 ? std::clamp((point - segment.from).dot(along) / length2, 0.0, 1.0) : 0.0;
  return segment.from + share * along;
}

}  // namespace

RayCaster::RayCaster(const World& world) {
  const Bounds bounds = bounds_of(world);
  const Point2 size = bounds.high - bounds.low;
  buckets_ = {static_cast<int>(size.x() / kBucketSide_m) + 3, static_cast<int>(size.y() / kBucketSide_m) + 3,
              kBucketSide_m, bounds.low - Point2::Constant(kBucketSide_m)};
  contents_.resize(buckets_.cell_count());
  for (const Object& object : world.objects) {
    const bool thin = is_thin(object.shape);
    has_thin_objects_ = has_thin_objects_ || thin;
    if (const auto* circle = std::get_if<Circle>(&object.shape)) {
      surfaces_.push_back({{circle->centre, circle->centre}, circle->radius_m, object.id, 0, object.material, thin});
    }
    std::uint16_t face = 0;
    for (const Segment& segment : segments_of(object.shape)) {
      surfaces_.push_back({segment, 0.0, object.id, face++, object.material, thin});
    }
  }
  for (std::size_t i = 0; i < surfaces_.size(); ++i) enter(i);
}

void RayCaster::enter(std::size_t surface) {
  const Surface& entered = surfaces_[surface];
  // Every bucket whose centre is near enough that the surface may touch it: a few too many do no harm.
  const double reach_m = kBucketSide_m * 0.75 + entered.radius_m;
  const Point2 low = entered.segment.from.cwiseMin(entered.segment.to) - Point2::Constant(entered.radius_m);
  const Point2 high = entered.segment.from.cwiseMax(entered.segment.to) + Point2::Constant(entered.radius_m);
  const Cell first = buckets_.cell_at(low - Point2::Constant(1e-9));
  const Cell last = buckets_.cell_at(high + Point2::Constant(1e-9));
  for (int row = first.row; row <= last.row; ++row) {
    for (int column = first.column; column <= last.column; ++column) {
      const Cell cell{column, row};
      if (!buckets_.contains(cell)) continue;
      if (distance_between(buckets_.centre_of(cell), entered.segment) <= reach_m) {
        contents_[buckets_.index_of(cell)].push_back(static_cast<std::uint32_t>(surface));
      }
    }
  }
}

inline std::span<const std::uint32_t> RayCaster::bucket(Cell cell) const {
  if (!buckets_.contains(cell)) return {};
  return contents_[buckets_.index_of(cell)];
}

RayHit RayCaster::hit_on(const Surface& surface, double range_m, const Point2& direction) {
  RayHit hit{range_m, surface.object, surface.face, surface.material, 1.0, surface.is_thin};
  if (surface.material != Material::kSolid && surface.radius_m == 0.0) {
    const Point2 along = surface.segment.to - surface.segment.from;
    hit.incidence_cosine = std::abs(cross(direction, along)) / along.norm();
  }
  return hit;
}

std::optional<RayHit> RayCaster::cast(const Point2& from, double bearing_rad, double max_range_m,
                                      const MovingSurfaces& moving) const {
  const Point2 direction{std::cos(bearing_rad), std::sin(bearing_rad)};
  double nearest_m = kNever;
  const Surface* met = nullptr;  // none while a mover is nearest
  for (const Circle& person : moving.round) {
    const double range_m = range_to(person, from, direction);
    nearest_m = std::min(nearest_m, range_m);
  }
  for (const Segment& edge : moving.straight) {
    const double range_m = range_to(edge, from, direction);
    nearest_m = std::min(nearest_m, range_m);
  }
  walk_ray(buckets_, from, from + max_range_m * direction, [&](Cell cell, double entered_m) {
    if (nearest_m < entered_m) return false;
    for (const std::uint32_t index : bucket(cell)) {
      const Surface& surface = surfaces_[index];
      const double range_m = surface.radius_m > 0.0
                                 ? range_to(Circle{surface.segment.from, surface.radius_m}, from, direction)
                                 : range_to(surface.segment, from, direction);
      if (range_m >= nearest_m) continue;
      nearest_m = range_m;
      met = &surface;
    }
    return true;
  });
  if (nearest_m > max_range_m) return std::nullopt;
  return met == nullptr ? RayHit{nearest_m, kMoverId, 0} : hit_on(*met, nearest_m, direction);
}

std::optional<RayCaster::Nearest> RayCaster::nearest_surface(const Point2& point, double within_m) const {
  std::optional<Nearest> nearest;
  double limit_m = within_m;
  const Cell first = buckets_.cell_at(point - Point2::Constant(within_m));
  const Cell last = buckets_.cell_at(point + Point2::Constant(within_m));
  for (int row = first.row; row <= last.row; ++row) {
    for (int column = first.column; column <= last.column; ++column) {
      for (const std::uint32_t index : bucket({column, row})) {
        const Surface& surface = surfaces_[index];
        const Point2 to_surface = nearest_point(surface.segment, point) - point;
        const double length_m = to_surface.norm();
        const double distance_m = std::abs(length_m - surface.radius_m);
        if (distance_m >= limit_m) continue;
        limit_m = distance_m;
        nearest =
            Nearest{distance_m, surface.object, length_m > 0.0 ? Point2{to_surface / length_m} : Point2{0.0, 0.0}};
      }
    }
  }
  return nearest;
}

}  // namespace deltamap::simulation
