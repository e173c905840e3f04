// SPDX-License-Identifier: Apache-2.0
// All that moves about in a simulated world besides the robot: people, actors and doors, and what they do that a map
// might take for a change.
#pragma once

#include <functional>
#include <vector>

#include "simulation/movers/actor.hpp"
#include "simulation/movers/door.hpp"
#include "simulation/movers/person.hpp"
#include "simulation/world/chance.hpp"

namespace deltamap::simulation {

/// Something stands still that was not there, or no longer does.
struct MoverEvent {
  enum class Kind : std::uint8_t { kStopped, kWent, kOpened, kShut };
  Kind kind = Kind::kStopped;
  int index = 0;  ///< of the actor, or of the door, in the order of the scenario
  Box box;        ///< stopped: where it stands
};

struct MoverParams {
  std::vector<PersonParams> people;
  std::vector<ActorParams> actors;
  std::vector<DoorParams> doors;
};

class Movers {
 public:
  enum class Kind : std::uint8_t { kPerson, kActor, kDoor };
  /// Each has its own chance.
  using Chance = std::function<Random(Kind kind, std::size_t index)>;
  Movers(const MoverParams& params, const Chance& chance);

  void move(double dt_s, const RayCaster& world, const Circle& robot);

  [[nodiscard]] const Bodies& bodies() const { return bodies_; }
  [[nodiscard]] const std::vector<Actor>& actors() const { return actors_; }
  [[nodiscard]] const std::vector<Door>& doors() const { return doors_; }
  /// What has happened since the last call; at first, which doors stand open.
  [[nodiscard]] std::vector<MoverEvent> take_events();

 private:
  void move_actors(double dt_s, const RayCaster& world, const Circle& robot);
  void move_doors(double dt_s, const Circle& robot);
  [[nodiscard]] std::vector<Circle> actors_but(std::size_t own) const;
  [[nodiscard]] Bodies current_bodies() const;

  std::vector<Person> people_;
  std::vector<Actor> actors_;
  std::vector<Door> doors_;
  Bodies bodies_;
  std::vector<MoverEvent> events_;
};

/// `Stream` has kPeople, kActor and kDoor among others (chance.hpp).
template <typename Stream>
[[nodiscard]] Movers::Chance chance_of_movers(std::uint64_t seed) {
  return [seed](Movers::Kind kind, std::size_t index) {
    const Stream stream = kind == Movers::Kind::kActor  ? Stream::kActor
                          : kind == Movers::Kind::kDoor ? Stream::kDoor
                                                        : Stream::kPeople;
    return random_for(seed, stream, index);
  };
}

}  // namespace deltamap::simulation
