// SPDX-License-Identifier: Apache-2.0
// What stood about at a moment of the rebuilt past and is no part of the map: actors that had stopped, the leaves of
// doors. It hides what lies behind it, and is no ghost where a map shows it.
#pragma once

#include <map>
#include <vector>

#include "simulation/scenario/scenario.hpp"
#include "simulation/scenario/truth.hpp"

namespace deltamap::simulation::score {

class Standing {
 public:
  /// Every door is shut until an event tells otherwise.
  explicit Standing(const Scenario& scenario);

  void apply(const MoverEvent& event);
  [[nodiscard]] MovingSurfaces surfaces() const { return {.straight = edges_}; }
  /// The world with all of it drawn, doors both shut and open.
  [[nodiscard]] World drawn_into(World world) const;

 private:
  void refresh();

  std::vector<DoorParams> doors_;
  std::vector<bool> open_;      // a door each
  std::map<int, Box> stopped_;  // by actor
  std::vector<Segment> edges_;
};

}  // namespace deltamap::simulation::score
