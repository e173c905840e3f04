// SPDX-License-Identifier: Apache-2.0
#include "simulation/movers/movers.hpp"

#include <utility>

namespace deltamap::simulation {

Movers::Movers(const MoverParams& params, const Chance& chance) {
  for (const PersonParams& person : params.people) people_.emplace_back(person, chance(Kind::kPerson, people_.size()));
  for (const ActorParams& actor : params.actors) actors_.emplace_back(actor, chance(Kind::kActor, actors_.size()));
  for (const DoorParams& door : params.doors) {
    const int index = static_cast<int>(doors_.size());
    doors_.emplace_back(door, chance(Kind::kDoor, doors_.size()));
    if (!doors_.back().is_shut()) events_.push_back({MoverEvent::Kind::kOpened, index, {}});
  }
  bodies_ = current_bodies();
}

void Movers::move(double dt_s, const RayCaster& world, const Circle& robot) {
  for (Person& person : people_) person.move(dt_s, world, robot, bodies_.leaves());
  move_actors(dt_s, world, robot);
  move_doors(dt_s, robot);
  bodies_ = current_bodies();
}

void Movers::move_actors(double dt_s, const RayCaster& world, const Circle& robot) {
  for (std::size_t i = 0; i < actors_.size(); ++i) {
    Actor& actor = actors_[i];
    const bool stood = actor.is_standing();
    if (stood) {
      actor.move(dt_s, {world, robot, {}, bodies_.leaves()});
    } else {
      const std::vector<Circle> others = actors_but(i);
      actor.move(dt_s, {world, robot, others, bodies_.leaves()});
    }
    if (stood == actor.is_standing()) continue;
    const auto kind = stood ? MoverEvent::Kind::kWent : MoverEvent::Kind::kStopped;
    events_.push_back({kind, static_cast<int>(i), actor.box()});
  }
}

void Movers::move_doors(double dt_s, const Circle& robot) {
  if (doors_.empty()) return;
  std::vector<Circle> bodies(bodies_.walkers().begin(), bodies_.walkers().end());
  bodies.push_back(robot);
  for (std::size_t i = 0; i < doors_.size(); ++i) {
    const bool was_shut = doors_[i].is_shut();
    doors_[i].move(dt_s, bodies);
    if (was_shut == doors_[i].is_shut()) continue;
    const auto kind = was_shut ? MoverEvent::Kind::kOpened : MoverEvent::Kind::kShut;
    events_.push_back({kind, static_cast<int>(i), {}});
  }
}

std::vector<Circle> Movers::actors_but(std::size_t own) const {
  std::vector<Circle> others;
  for (std::size_t i = 0; i < actors_.size(); ++i) {
    if (i == own || !actors_[i].is_in_hall()) continue;
    for (const Circle& part : actors_[i].cover()) others.push_back(part);
  }
  return others;
}

Bodies Movers::current_bodies() const {
  Bodies bodies;
  for (const Person& person : people_) bodies.add_person(person.body());
  for (const Actor& actor : actors_) {
    if (!actor.is_in_hall()) continue;
    if (actor.is_forklift()) {
      bodies.add_truck(actor.box());
    } else {
      bodies.add_person(actor.person());
    }
  }
  for (const Door& door : doors_) {
    if (const auto leaf = door.leaf()) bodies.add_leaf(*leaf);
  }
  return bodies;
}

std::vector<MoverEvent> Movers::take_events() { return std::exchange(events_, {}); }

}  // namespace deltamap::simulation
