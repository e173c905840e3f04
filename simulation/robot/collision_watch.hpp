// SPDX-License-Identifier: Apache-2.0
// Counts what the robot's body bumps into. A contact that lasts is one collision; it has ended once there is room
// around the body again. Whatever else it touches meanwhile is a collision of its own.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "simulation/robot/robot.hpp"
#include "simulation/world/ray_caster.hpp"

namespace deltamap::simulation {

struct Collision {
  Timestamp time;
  int object = kMoverId;       ///< id in the world; kMoverId: a person, a fork-lift or a door
  double speed_m_per_s = 0.0;  ///< of the body by its own wheels; 0: it stood, or was carried
  Pose2 map_from_robot;
};

class CollisionWatch {
 public:
  /// After each step of the body.
  void observe(Timestamp time, const Robot& body, const RayCaster& world, std::span<const Circle> movers);
  [[nodiscard]] const std::vector<Collision>& collisions() const { return collisions_; }

 private:
  std::vector<Collision> collisions_;
  std::vector<int> touched_;  // objects of the contact that lasts
};

}  // namespace deltamap::simulation
