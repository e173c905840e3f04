// SPDX-License-Identifier: Apache-2.0
// A door whose leaf swings or slides open and shut again, at times drawn by chance about a mean. It waits for whoever
// stands in its way.
#pragma once

#include <optional>
#include <span>

#include "core/random.hpp"
#include "simulation/world/shapes.hpp"

namespace deltamap::simulation {

struct DoorParams {
  Segment closed;              ///< the leaf while it is shut, from its hinge
  double swing_rad = 0.0;      ///< about the hinge until it stands open; 0: it slides along itself into the wall
  double period_s = 60.0;      ///< mean time from one opening to the next, > 0
  double open_share = 0.3;     ///< of the time that it stands open, [0, 1]
  double moving_s = 2.0;       ///< from shut to open, > 0
  bool is_drawn_open = false;  ///< in the map of the start
};

/// The leaf of a door that is so far open, [0, 1]; none where it has slid away.
[[nodiscard]] std::optional<Segment> leaf_of(const DoorParams& door, double openness);

class Door {
 public:
  Door(const DoorParams& params, Random random);

  void move(double dt_s, std::span<const Circle> robot_and_walkers);

  [[nodiscard]] std::optional<Segment> leaf() const { return leaf_of(params_, openness_); }
  [[nodiscard]] bool is_shut() const { return openness_ == 0.0; }
  [[nodiscard]] const DoorParams& params() const { return params_; }

 private:
  [[nodiscard]] double phase_s();
  [[nodiscard]] bool would_hit(double openness, std::span<const Circle> bodies) const;

  DoorParams params_;
  Random random_;
  bool opening_ = false;  // wanted open
  double openness_ = 0.0;
  double phase_left_s_ = 0.0;
};

}  // namespace deltamap::simulation
