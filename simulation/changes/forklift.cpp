// SPDX-License-Identifier: Apache-2.0
#include "simulation/changes/forklift.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulation/world/standing_room.hpp"

namespace deltamap::simulation {
namespace {

constexpr int kTries = 60;                // proposals before the fork-lift skips a turn
constexpr double kNeighbourGap_m = 1e-3;  // containers of a block touch

World with_all_slots_filled(World world, const std::vector<Box>& slots) {
  int id = world.largest_id();
  for (const Box& slot : slots) world.objects.push_back({++id, ObjectKind::kContainer, slot});
  return world;
}

int container_at(const Box& slot, const World& world) {
  for (const Object& object : world.objects) {
    const Box* box = object.kind == ObjectKind::kContainer ? std::get_if<Box>(&object.shape) : nullptr;
    if (box != nullptr && (box->centre - slot.centre).norm() < kNeighbourGap_m) return object.id;
  }
  return 0;
}

}  // namespace

bool is_exposed(const Box& box, const ReachableFloor& floor, double clearance_m) {
  const auto sides = faces(box);
  return std::any_of(sides.begin(), sides.end(), [&](const Segment& face) {
    const Point2 middle = 0.5 * (face.from + face.to);
    const Point2 outward = (middle - box.centre).normalized();
    constexpr double kStep_m = 0.3;  // more than a floor cell's diagonal
    return floor.contains(middle + (clearance_m + kStep_m) * outward);
  });
}

Forklift::Forklift(const ForkliftParams& params, std::vector<Box> slots, const World& initial_world,
                   const Point2& robot_start, Random random)
    : params_{params},
      lanes_{reachable_floor(with_all_slots_filled(initial_world, slots), robot_start, 0.5 * params.passage_m)},
      next_id_{initial_world.largest_id() + 1},
      random_{random} {
  for (const Box& slot : slots) slots_.push_back({slot, container_at(slot, initial_world)});
}

std::optional<Change> Forklift::next_change(const World& world, const Circle& robot, std::span<const Circle> people,
                                            const MayTouch& may_touch) {
  if (slots_.empty() || params_.kinds.empty()) return std::nullopt;
  const ReachableFloor floor = reachable_floor(world, robot.centre, 0.5 * params_.passage_m);
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const ChangeKind kind = params_.kinds[random_.index_below(static_cast<std::uint32_t>(params_.kinds.size()))];
    Slot& slot = slots_[random_.index_below(static_cast<std::uint32_t>(slots_.size()))];
    const auto change = proposed(kind, slot, world);
    if (!change) continue;
    if (may_touch && !(may_touch(change->box) && (!change->from || may_touch(*change->from)))) continue;
    if (!is_harmless(*change, world, floor, robot, people)) continue;
    note(*change, slot);
    return change;
  }
  return std::nullopt;
}

std::optional<Change> Forklift::proposed(ChangeKind kind, Slot& slot, const World& world) {
  if (kind == ChangeKind::kAdded) {
    if (slot.container != 0) return std::nullopt;
    return Change{kind, next_id_, slot.home, std::nullopt};
  }
  const Object* container = slot.container == 0 ? nullptr : world.find(slot.container);
  const Box* box = container == nullptr ? nullptr : std::get_if<Box>(&container->shape);
  if (box == nullptr) return std::nullopt;
  if (kind == ChangeKind::kShifted) return Change{kind, container->id, shifted(*box, slot.home), *box};
  const auto filled = std::count_if(slots_.begin(), slots_.end(), [](const Slot& s) { return s.container != 0; });
  if (static_cast<double>(filled - 1) < params_.least_filled * static_cast<double>(slots_.size())) return std::nullopt;
  return Change{kind, container->id, *box, std::nullopt};
}

Box Forklift::shifted(const Box& box, const Box& home) {
  if (params_.shifts_anywhere) {
    const double most_m = params_.largest_shift_m;
    const Point2 offset{random_.uniform(-most_m, most_m), random_.uniform(-most_m, most_m)};
    const double turn_rad = random_.uniform(-params_.largest_turn_rad, params_.largest_turn_rad);
    const Pose2 map_from_shifted = home.map_from_box() * Pose2{offset.x(), offset.y(), turn_rad};
    return {map_from_shifted.position(), home.width_m, home.height_m, map_from_shifted.theta};
  }
  const double distance_m = random_.uniform(params_.smallest_shift_m, params_.largest_shift_m);
  const double direction_rad = home.theta_rad + 0.5 * std::numbers::pi * random_.index_below(4);
  Box moved = box;
  moved.centre += distance_m * Point2{std::cos(direction_rad), std::sin(direction_rad)};
  return moved;
}

bool Forklift::is_harmless(const Change& change, const World& world, const ReachableFloor& floor, const Circle& robot,
                           std::span<const Circle> people) const {
  const auto keeps_away_from_all = [&](const Box& box) {
    return keeps_away(box, robot, params_.robot_margin_m) && keeps_away(box, people, params_.people_margin_m);
  };
  if (!keeps_away_from_all(change.box) || (change.from && !keeps_away_from_all(*change.from))) return false;
  const double clearance_m = 0.5 * params_.passage_m;
  if (!is_exposed(change.from.value_or(change.box), floor, clearance_m)) return false;
  if (change.kind == ChangeKind::kRemoved) return true;
  if (!stands_free(change.box, change.id, world)) return false;
  if (change.kind == ChangeKind::kShifted && !params_.shifts_anywhere) {
    const auto slot =
        std::find_if(slots_.begin(), slots_.end(), [&](const Slot& s) { return s.container == change.id; });
    if ((change.box.centre - slot->home.centre).norm() > params_.largest_shift_m) return false;
  }
  const ReachableFloor after = reachable_floor(changed(world, change), robot.centre, clearance_m);
  return is_exposed(change.box, after, clearance_m) && share_still_reached(lanes_, after) >= params_.lanes_kept;
}

void Forklift::learn(const Change& change) {
  next_id_ = std::max(next_id_, change.id + 1);
  const auto same = [&](const Slot& slot) { return slot.container == change.id; };
  const auto own = std::find_if(slots_.begin(), slots_.end(), same);
  if (change.kind == ChangeKind::kRemoved && own != slots_.end()) own->container = 0;
  if (change.kind != ChangeKind::kAdded) return;
  Slot* nearest = nullptr;
  double nearest_m = params_.largest_shift_m;
  for (Slot& slot : slots_) {
    const double away_m = (slot.home.centre - change.box.centre).norm();
    if (slot.container != 0 || away_m > nearest_m) continue;
    nearest = &slot;
    nearest_m = away_m;
  }
  if (nearest != nullptr) nearest->container = change.id;
}

void Forklift::note(const Change& change, Slot& slot) {
  if (change.kind == ChangeKind::kRemoved) slot.container = 0;
  if (change.kind == ChangeKind::kAdded) slot.container = next_id_++;
}

}  // namespace deltamap::simulation
