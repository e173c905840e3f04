// SPDX-License-Identifier: Apache-2.0
// Points and poses of the plane, SE(2). Transforms are named parent_from_child, so that neighbours cancel:
//   map_from_laser = map_from_robot * robot_from_laser;   hit_in_map = map_from_laser * hit_in_laser;
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "core/geometry/angle.hpp"

namespace deltamap {

using Point2 = Eigen::Vector2d;  ///< metres

struct Pose2 {
  double x = 0.0;      ///< m
  double y = 0.0;      ///< m
  double theta = 0.0;  ///< rad, (-π, π]

  [[nodiscard]] Point2 position() const { return {x, y}; }
  friend bool operator==(const Pose2&, const Pose2&) = default;
};

/// Covariance of (x, y, theta): m², m·rad, rad².
using PoseCovariance = Eigen::Matrix3d;

[[nodiscard]] inline Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c) {
  const double c = std::cos(a_from_b.theta);
  const double s = std::sin(a_from_b.theta);
  return {a_from_b.x + c * b_from_c.x - s * b_from_c.y, a_from_b.y + s * b_from_c.x + c * b_from_c.y,
          wrapped_angle(a_from_b.theta + b_from_c.theta)};
}

[[nodiscard]] inline Point2 operator*(const Pose2& a_from_b, const Point2& point_in_b) {
  const double c = std::cos(a_from_b.theta);
  const double s = std::sin(a_from_b.theta);
  return {a_from_b.x + c * point_in_b.x() - s * point_in_b.y(), a_from_b.y + s * point_in_b.x() + c * point_in_b.y()};
}

[[nodiscard]] inline Pose2 inverse(const Pose2& a_from_b) {
  const double c = std::cos(a_from_b.theta);
  const double s = std::sin(a_from_b.theta);
  return {-c * a_from_b.x - s * a_from_b.y, s * a_from_b.x - c * a_from_b.y, wrapped_angle(-a_from_b.theta)};
}

/// The motion between two poses of the same frame, seen from the first: inverse(from) * to.
[[nodiscard]] inline Pose2 motion_between(const Pose2& from, const Pose2& to) { return inverse(from) * to; }

/// The pose a share of the way from one pose to another; heading the short way round. A share above 1 extrapolates.
[[nodiscard]] inline Pose2 interpolated(const Pose2& from, const Pose2& to, double share) {
  return {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y),
          wrapped_angle(from.theta + share * turn_between(from.theta, to.theta))};
}

/// Coordinate by coordinate; heading the short way round.
[[nodiscard]] inline Eigen::Vector3d difference(const Pose2& from, const Pose2& to) {
  return {to.x - from.x, to.y - from.y, turn_between(from.theta, to.theta)};
}

[[nodiscard]] inline double distance_between(const Pose2& a, const Pose2& b) {
  return std::hypot(b.x - a.x, b.y - a.y);
}

}  // namespace deltamap
