// SPDX-License-Identifier: Apache-2.0
// The particles, as a structure of arrays: where the robot may be in the map, and how well each guess has fitted since
// the last resampling. Capacity is taken once; nothing is allocated while scans come.
#pragma once

#include <cstddef>
#include <vector>

#include "core/geometry/pose2.hpp"

namespace deltamap::localization::particles {

struct ParticleSet {
  std::vector<double> x_m;          ///< map frame
  std::vector<double> y_m;          ///< map frame
  std::vector<double> heading_rad;  ///< (-π, π]
  std::vector<double> log_weight;   ///< accumulated since the last resampling; the best is 0
  std::vector<double> weight;       ///< normalized exp(log_weight); sums to 1

  [[nodiscard]] std::size_t size() const { return x_m.size(); }
  [[nodiscard]] Pose2 pose(std::size_t i) const { return {x_m[i], y_m[i], heading_rad[i]}; }
  void set_pose(std::size_t i, const Pose2& map_from_robot) {
    x_m[i] = map_from_robot.x;
    y_m[i] = map_from_robot.y;
    heading_rad[i] = map_from_robot.theta;
  }
  /// All equally likely.
  void resize_uniform(std::size_t count) {
    for (auto* column : {&x_m, &y_m, &heading_rad}) column->resize(count);
    log_weight.assign(count, 0.0);
    weight.assign(count, count > 0 ? 1.0 / static_cast<double>(count) : 0.0);
  }
};

}  // namespace deltamap::localization::particles
