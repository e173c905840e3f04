// SPDX-License-Identifier: Apache-2.0
// How unsure a motion is beside what its wheels usually are: where they were contradicted, and scans took their place.
#pragma once

#include "core/geometry/pose2.hpp"

namespace deltamap::localization::motion {

struct MotionVariance {
  double position_m2 = 0.0;  ///< along either axis
  double heading_rad2 = 0.0;

  [[nodiscard]] bool is_none() const { return position_m2 == 0.0 && heading_rad2 == 0.0; }
  [[nodiscard]] PoseCovariance covariance() const {
    return Eigen::Vector3d{position_m2, position_m2, heading_rad2}.asDiagonal();
  }
  MotionVariance& operator+=(const MotionVariance& more) {
    position_m2 += more.position_m2;
    heading_rad2 += more.heading_rad2;
    return *this;
  }
};

}  // namespace deltamap::localization::motion
