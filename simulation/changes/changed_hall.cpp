// SPDX-License-Identifier: Apache-2.0
#include "simulation/changes/changed_hall.hpp"

#include <algorithm>

namespace deltamap::simulation {
namespace {

constexpr double kInSlot_m = 0.01;  // from its middle

bool stands_at(const World& world, const Box& slot) {
  return std::any_of(world.objects.begin(), world.objects.end(), [&](const Object& object) {
    const Box* box = std::get_if<Box>(&object.shape);
    return box != nullptr && (box->centre - slot.centre).norm() < kInSlot_m;
  });
}

/// A container that was put where one was taken away is that one again.
World with_former_ids(World world, const World& before) {
  for (const Object& former : before.objects) {
    const Box* place = std::get_if<Box>(&former.shape);
    if (place == nullptr || former.kind != ObjectKind::kContainer || world.find(former.id) != nullptr) continue;
    const auto again = std::find_if(world.objects.begin(), world.objects.end(), [&](const Object& object) {
      const Box* box = std::get_if<Box>(&object.shape);
      return box != nullptr && object.kind == ObjectKind::kContainer && before.find(object.id) == nullptr &&
             box->centre == place->centre;
    });
    if (again != world.objects.end()) *again = former;
  }
  return world;
}

/// One change for each container that is not where it was: those that have gone, then those that have come or moved.
std::vector<Change> net_changes(const World& before, const World& now) {
  std::vector<Change> changes;
  for (const Object& object : before.objects) {
    const Box* box = std::get_if<Box>(&object.shape);
    if (box != nullptr && now.find(object.id) == nullptr)
      changes.push_back({ChangeKind::kRemoved, object.id, *box, std::nullopt});
  }
  for (const Object& object : now.objects) {
    const Box* box = std::get_if<Box>(&object.shape);
    if (box == nullptr || object.kind != ObjectKind::kContainer) continue;
    const Object* former = before.find(object.id);
    const Box* from = former == nullptr ? nullptr : std::get_if<Box>(&former->shape);
    if (from == nullptr) {
      changes.push_back({ChangeKind::kAdded, object.id, *box, std::nullopt});
    } else if (from->centre != box->centre) {
      changes.push_back({ChangeKind::kShifted, object.id, *box, *from});
    }
  }
  return changes;
}

}  // namespace

ForkliftParams forklift_for(const ChangedStartParams& start) {
  ForkliftParams forklift;
  forklift.kinds = start.kinds;
  forklift.smallest_shift_m = start.smallest_shift_m;
  forklift.largest_shift_m = start.largest_shift_m;
  forklift.least_filled = start.least_filled;
  return forklift;
}

ChangedHall changed_hall(const HallBounds& bounds, const ForkliftParams& params, const std::vector<Box>& slots,
                         const World& before, const World& now, const Circle& robot, std::span<const Circle> people,
                         Random random) {
  Forklift forklift{params, slots, now, robot.centre, random};
  const auto differing = [&](const World& world) {
    return std::count_if(slots.begin(), slots.end(),
                         [&](const Box& slot) { return stands_at(world, slot) != stands_at(before, slot); });
  };
  const double wanted = bounds.share * static_cast<double>(slots.size());
  const std::size_t most = bounds.most_acts_a_slot * slots.size();
  ChangedHall hall{now, {}};
  while (static_cast<double>(differing(hall.world)) < wanted && hall.changes.size() < most) {
    const auto done = forklift.next_change(hall.world, robot, people);
    if (!done) break;
    hall.world = changed(hall.world, *done);
    hall.changes.push_back(*done);
  }
  return hall;
}

ChangedHall changed_start(const ChangedStartParams& params, const std::vector<Box>& slots, const World& before,
                          const Circle& robot, std::span<const Circle> people, Random random) {
  // Some acts undo earlier ones: three quarters of a hall take many.
  const HallBounds bounds{.share = params.share, .most_acts_a_slot = 40};
  ChangedHall hall = changed_hall(bounds, forklift_for(params), slots, before, before, robot, people, random);
  hall.world = with_former_ids(hall.world, before);
  hall.changes = net_changes(before, hall.world);
  return hall;
}

}  // namespace deltamap::simulation
