// SPDX-License-Identifier: Apache-2.0
// The last half second of the robot and of all that moves, so that a beam can be cast from where the robot was at its
// time.
#pragma once

#include <deque>

#include "core/time.hpp"
#include "simulation/devices/set_points.hpp"
#include "simulation/world/bodies.hpp"

namespace deltamap::simulation {

struct Moment {
  Timestamp time;
  Pose2 map_from_robot;
  devices::WheelMotion wheels;
  Bodies bodies;
};

class MotionHistory {
 public:
  void add(Moment moment);
  [[nodiscard]] const Moment& newest() const { return moments_.back(); }

  /// Between the two nearest moments; the oldest or newest outside of what is kept.
  [[nodiscard]] Pose2 map_from_robot_at(Timestamp time) const;
  /// The wheels' pose between the two nearest moments, all else of the later one.
  [[nodiscard]] devices::WheelMotion wheels_at(Timestamp time) const;
  /// All that moves, at the nearest later moment.
  [[nodiscard]] const Bodies& bodies_at(Timestamp time) const;

 private:
  struct Between {
    const Moment* before;
    const Moment* after;
    double share;
  };
  [[nodiscard]] Between around(Timestamp time) const;

  std::deque<Moment> moments_;
};

}  // namespace deltamap::simulation
