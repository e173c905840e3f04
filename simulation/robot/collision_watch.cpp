// SPDX-License-Identifier: Apache-2.0
#include "simulation/robot/collision_watch.hpp"

#include <algorithm>

namespace deltamap::simulation {

void CollisionWatch::observe(Timestamp time, const Robot& body, const RayCaster& world,
                             std::span<const Circle> movers) {
  constexpr double kRoomAgain_m = 0.02;
  const RobotState& state = body.state();
  if (!state.contact) {
    if (!touched_.empty() && !body.touches(kRoomAgain_m, world, movers)) touched_.clear();
    return;
  }
  const int object = state.contact->object;
  if (std::find(touched_.begin(), touched_.end(), object) != touched_.end()) return;
  touched_.push_back(object);
  collisions_.push_back({time, object, state.contact->speed_m_per_s, state.map_from_robot});
}

}  // namespace deltamap::simulation
