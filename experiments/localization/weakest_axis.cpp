// SPDX-License-Identifier: Apache-2.0
#include "experiments/localization/weakest_axis.hpp"

#include <cmath>

#include "core/geometry/principal_axes.hpp"

namespace deltamap::experiments {
namespace {

/// Unit normal of the surface that was met.
Point2 normal_at(const simulation::Shape& shape, int face, const Point2& hit) {
  if (const auto* circle = std::get_if<simulation::Circle>(&shape)) return (hit - circle->centre).normalized();
  const simulation::Segment segment = simulation::segments_of(shape)[static_cast<std::size_t>(face)];
  const Point2 along = (segment.to - segment.from).normalized();
  return {-along.y(), along.x()};
}

}  // namespace

WeakestAxis weakest_axis(const simulation::World& world, const simulation::RayCaster& surfaces,
                         const Pose2& map_from_laser, double max_range_m) {
  constexpr int kBeams = 181;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (int beam = 0; beam < kBeams; ++beam) {
    const double bearing_rad = map_from_laser.theta + radians(beam - 90.0);
    const auto hit = surfaces.cast(map_from_laser.position(), bearing_rad, max_range_m);
    if (!hit) continue;
    const Point2 ray = hit->range_m * Point2{std::cos(bearing_rad), std::sin(bearing_rad)};
    const Point2 normal = normal_at(world.find(hit->object)->shape, hit->face, map_from_laser.position() + ray);
    const Eigen::Vector3d gradient{normal.x(), normal.y(), normal.y() * ray.x() - normal.x() * ray.y()};
    information += gradient * gradient.transpose();
  }
  Eigen::Matrix2d position = information.topLeftCorner<2, 2>();
  if (information(2, 2) > 0.0) {
    position -= information.topRightCorner<2, 1>() * information.topRightCorner<2, 1>().transpose() / information(2, 2);
  }
  const PrincipalAxes axes = principal_axes(position);
  const double least = std::max(0.0, axes.values[0]);
  const double most = axes.values[1];
  return {axes.vectors.col(0), most > 0.0 ? least / most : 0.0};
}

}  // namespace deltamap::experiments
