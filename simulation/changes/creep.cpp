// SPDX-License-Identifier: Apache-2.0
#include "simulation/changes/creep.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "simulation/changes/forklift.hpp"
#include "simulation/world/standing_room.hpp"

namespace deltamap::simulation {
namespace {

constexpr double kLanesKept = 0.95;  // of the floor: a container in a corridor covers a little of it

template <typename Item>
void shuffle(std::vector<Item>& items, Random& random) {
  for (std::size_t left = items.size(); left > 1; --left) {
    std::swap(items[left - 1], items[random.index_below(static_cast<std::uint32_t>(left))]);
  }
}

std::vector<Object> containers_of(const World& world) {
  std::vector<Object> containers;
  for (const Object& object : world.objects) {
    if (object.kind == ObjectKind::kContainer && std::holds_alternative<Box>(object.shape))
      containers.push_back(object);
  }
  return containers;
}

std::vector<double> directions_of(const Box& box, const std::optional<double>& given_rad, Random& random) {
  if (given_rad) return {*given_rad};
  std::vector<double> directions;
  for (int quarter = 0; quarter < 4; ++quarter) directions.push_back(box.theta_rad + 0.5 * std::numbers::pi * quarter);
  shuffle(directions, random);
  return directions;
}

Box moved(Box box, const Point2& way) {
  box.centre += way;
  return box;
}

}  // namespace

Creep::Creep(const CreepParams& params, const World& initial_world, const Point2& robot_start, Random random)
    : params_{params} {
  const double clearance_m = 0.5 * params_.passage_m;
  const ReachableFloor lanes = reachable_floor(initial_world, robot_start, clearance_m);
  World world = initial_world;  // with those already chosen at their ends
  const auto has_room = [&](const Object& container, const Box& box, const Point2& step) {
    if (!is_exposed(box, lanes, clearance_m)) return false;
    for (int push = 1; push <= params_.times; ++push) {
      const Box there = moved(box, push * step);
      if (!stands_free(there, container.id, world)) return false;
      if (!keeps_away(there, Circle{robot_start, 0.0}, 1.0)) return false;
    }
    const World after = changed(world, {ChangeKind::kCrept, container.id, moved(box, params_.times * step), box});
    if (share_still_reached(lanes, reachable_floor(after, robot_start, clearance_m)) < kLanesKept) return false;
    world = after;
    return true;
  };
  std::vector<Object> containers = containers_of(initial_world);
  shuffle(containers, random);
  for (const Object& container : containers) {
    if (std::cmp_greater_equal(creeping_.size(), params_.containers)) break;
    const Box box = std::get<Box>(container.shape);
    for (const double direction_rad : directions_of(box, params_.direction_rad, random)) {
      const Point2 step = params_.step_m * Point2{std::cos(direction_rad), std::sin(direction_rad)};
      if (!has_room(container, box, step)) continue;
      creeping_.push_back({container.id, step, params_.times});
      break;
    }
  }
}

std::vector<Change> Creep::pushes(const World& world, const Circle& robot, std::span<const Circle> people) {
  std::vector<Change> done;
  World now = world;
  for (Creeping& creeping : creeping_) {
    const Object* container = creeping.left == 0 ? nullptr : now.find(creeping.id);
    const Box* from = container == nullptr ? nullptr : std::get_if<Box>(&container->shape);
    if (from == nullptr) continue;
    const Box there = moved(*from, creeping.step);
    const bool is_harmless = stands_free(there, creeping.id, now) && keeps_away(there, robot, params_.robot_margin_m) &&
                             keeps_away(there, people, params_.people_margin_m);
    if (!is_harmless) continue;
    done.push_back({ChangeKind::kCrept, creeping.id, there, *from});
    now = changed(now, done.back());
    --creeping.left;
  }
  return done;
}

}  // namespace deltamap::simulation
