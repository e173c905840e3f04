// SPDX-License-Identifier: Apache-2.0
// Points of one scan brought into the map, with the sine of its heading taken once for all of them.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "core/geometry/pose2.hpp"

namespace deltamap {

/// As map_from_robot * point.
class PointsInMap {
 public:
  explicit PointsInMap(const Pose2& map_from_robot)
      : pose_{map_from_robot}, c_{std::cos(map_from_robot.theta)}, s_{std::sin(map_from_robot.theta)} {}

  [[nodiscard]] Point2 operator()(const Point2& in_robot) const {
    return {pose_.x + c_ * in_robot.x() - s_ * in_robot.y(), pose_.y + s_ * in_robot.x() + c_ * in_robot.y()};
  }
  [[nodiscard]] Point2 operator()(const Eigen::Vector2f& in_robot) const {
    return (*this)(Point2{in_robot.cast<double>()});
  }

 private:
  Pose2 pose_;
  double c_;
  double s_;
};

}  // namespace deltamap
