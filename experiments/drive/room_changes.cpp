// SPDX-License-Identifier: Apache-2.0
#include "experiments/drive/room_changes.hpp"

#include <cassert>
#include <utility>

namespace deltamap::experiments {

RoomChanges::RoomChanges(const RoomChangesParams& params, const simulation::Scenario& scenario, Random random)
    : params_{params}, next_id_{scenario.world.largest_id() + 1}, next_s_{params.settle_s} {
  std::vector<simulation::Object> containers;
  for (const simulation::Object& object : scenario.world.objects) {
    if (object.kind == simulation::ObjectKind::kContainer) containers.push_back(object);
  }
  const auto piles = static_cast<std::uint32_t>(containers.size()) / static_cast<std::uint32_t>(params.boxes_a_pile);
  assert(piles > 0 && "the room has an obstacle");
  const auto first = static_cast<std::ptrdiff_t>(random.index_below(piles)) * params.boxes_a_pile;
  std::vector<simulation::Object> pile{containers.begin() + first, containers.begin() + first + params.boxes_a_pile};
  while (boxes_.size() < static_cast<std::size_t>(params.boxes)) {
    const auto chosen = pile.begin() + random.index_below(static_cast<std::uint32_t>(pile.size()));
    boxes_.push_back(*chosen);
    pile.erase(chosen);
  }
}

std::optional<simulation::Change> RoomChanges::due(double passed_s, const simulation::VirtualDrive& drive) {
  if (passed_s < next_s_ || done_ == 2 * boxes_.size()) return std::nullopt;
  const bool goes = done_ < boxes_.size();
  // Back in the opposite order: what was behind comes first.
  const simulation::Object& box = goes ? boxes_[done_] : boxes_[2 * boxes_.size() - 1 - done_];
  const double way_m = distance_between(drive.map_from_robot().position(), box.shape);
  if (!goes && way_m < drive.robot_radius_m() + params_.margin_m) return std::nullopt;
  ++done_;
  next_s_ = passed_s + (done_ % boxes_.size() == 0 ? params_.look_s : params_.every_s);
  const auto kind = goes ? simulation::ChangeKind::kRemoved : simulation::ChangeKind::kAdded;
  return simulation::Change{kind, goes ? box.id : next_id_++, std::get<simulation::Box>(box.shape), std::nullopt};
}

bool RoomChanges::is_emptied(double passed_s) const { return done_ == boxes_.size() && passed_s >= next_s_; }

bool RoomChanges::is_over(double passed_s) const { return done_ == 2 * boxes_.size() && passed_s >= next_s_; }

}  // namespace deltamap::experiments
