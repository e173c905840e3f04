// SPDX-License-Identifier: Apache-2.0
#include "simulation/score/standing.hpp"

namespace deltamap::simulation::score {

Standing::Standing(const Scenario& scenario) : doors_{scenario.doors}, open_(scenario.doors.size(), false) {
  refresh();
}

void Standing::apply(const MoverEvent& event) {
  const auto door = static_cast<std::size_t>(event.index);
  switch (event.kind) {
    case MoverEvent::Kind::kStopped:
      stopped_[event.index] = event.box;
      break;
    case MoverEvent::Kind::kWent:
      stopped_.erase(event.index);
      break;
    case MoverEvent::Kind::kOpened:
    case MoverEvent::Kind::kShut:
      if (door < open_.size()) open_[door] = event.kind == MoverEvent::Kind::kOpened;
      break;
  }
  refresh();
}

void Standing::refresh() {
  edges_.clear();
  for (const auto& [actor, box] : stopped_) {
    for (const Segment& face : faces(box)) edges_.push_back(face);
  }
  for (std::size_t i = 0; i < doors_.size(); ++i) {
    if (const auto leaf = leaf_of(doors_[i], open_[i] ? 1.0 : 0.0)) edges_.push_back(*leaf);
  }
}

World Standing::drawn_into(World world) const {
  int id = world.largest_id();
  for (const auto& [actor, box] : stopped_) world.objects.push_back({++id, ObjectKind::kPost, box});
  for (const DoorParams& door : doors_) {
    for (const double openness : {0.0, 1.0}) {
      const auto leaf = leaf_of(door, openness);
      if (leaf) world.objects.push_back({++id, ObjectKind::kDoor, Polyline{{leaf->from, leaf->to}}});
    }
  }
  return world;
}

}  // namespace deltamap::simulation::score
