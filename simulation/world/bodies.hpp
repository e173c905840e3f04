// SPDX-License-Identifier: Apache-2.0
// Everything that moves about in a simulated world, at one moment: people, fork-lifts, the leaves of doors.
#pragma once

#include <span>
#include <vector>

#include "simulation/world/shapes.hpp"

namespace deltamap::simulation {

/// What of it a beam can meet.
struct MovingSurfaces {
  std::span<const Circle> round{};
  std::span<const Segment> straight{};
};

class Bodies {
 public:
  void add_person(const Circle& person);
  void add_truck(const Box& truck);
  /// All leaves come last.
  void add_leaf(const Segment& leaf);

  [[nodiscard]] MovingSurfaces surfaces() const { return {people_, edges_}; }
  /// People, and circles that cover the fork-lifts.
  [[nodiscard]] std::span<const Circle> walkers() const { return std::span{obstacles_}.first(walkers_); }
  [[nodiscard]] std::span<const Segment> leaves() const { return std::span{edges_}.subspan(truck_edges_); }
  /// The walkers, and circles strung along the leaves: what one can bump into.
  [[nodiscard]] std::span<const Circle> obstacles() const { return obstacles_; }

 private:
  std::vector<Circle> people_;
  std::vector<Segment> edges_;     // of fork-lifts, then of leaves
  std::vector<Circle> obstacles_;  // walkers, then along leaves
  std::size_t walkers_ = 0;
  std::size_t truck_edges_ = 0;
};

/// Three circles that cover a box about twice as long (its width) as wide (its height).
[[nodiscard]] std::vector<Circle> cover_of(const Box& truck);
/// Small circles a hand's breadth apart.
[[nodiscard]] std::vector<Circle> beads_of(const Segment& leaf);

}  // namespace deltamap::simulation
