// SPDX-License-Identifier: Apache-2.0
// Containers that creep: the same few are pushed on by a little, again and again, each in one direction. Every push is
// too small to be told from a wrong pose; a map that follows them all by its pose walks away with them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/random.hpp"
#include "simulation/changes/change.hpp"

namespace deltamap::simulation {

struct CreepParams {
  int containers = 4;                     ///< that creep, > 0; fewer where no more have the room
  double step_m = 0.05;                   ///< of a push, > 0
  int times = 20;                         ///< that each is pushed, > 0
  double every_s = 60.0;                  ///< between pushes of one container, > 0
  std::optional<double> direction_rad{};  ///< map frame; none: one of each container's own four, by chance
  double robot_margin_m = 0.5;            ///< between a container that is pushed and the robot's body, >= 0
  double people_margin_m = 0.5;           ///< the same of people, >= 0
  double passage_m = 1.4;                 ///< width that corridors keep, > 0
};

class Creep {
 public:
  /// Chooses the containers by chance among those that have the whole way free and can be seen.
  Creep(const CreepParams& params, const World& initial_world, const Point2& robot_start, Random random);

  /// One push of each container that is not yet at its end and that can be pushed now without harm; to be called every
  /// `every_s`.
  [[nodiscard]] std::vector<Change> pushes(const World& world, const Circle& robot, std::span<const Circle> people);

  [[nodiscard]] std::size_t containers() const { return creeping_.size(); }

 private:
  struct Creeping {
    int id = 0;
    Point2 step{0.0, 0.0};  // m, map frame
    int left = 0;
  };

  CreepParams params_;
  std::vector<Creeping> creeping_;
};

}  // namespace deltamap::simulation
