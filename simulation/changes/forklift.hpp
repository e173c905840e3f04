// SPDX-License-Identifier: Apache-2.0
// The paper's virtual fork-lift (§4): on a schedule it removes a container, brings one to an empty slot, or shifts one.
// It touches only containers that it can reach from the corridors, keeps away from the robot and from people, and
// leaves every corridor passable.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/random.hpp"
#include "simulation/changes/change.hpp"
#include "simulation/world/passages.hpp"

namespace deltamap::simulation {

struct ForkliftParams {
  double change_every_s = 60.0;  ///< between changes, > 0; the paper: one a minute
  std::vector<ChangeKind> kinds{ChangeKind::kRemoved, ChangeKind::kAdded};
  double smallest_shift_m = 0.3;  ///< > 0
  double largest_shift_m = 0.8;   ///< of a container from its slot, >= smallest_shift_m
  bool shifts_anywhere = false;   ///< within largest_shift_m of the slot in x and in y, not along the sides alone
  double largest_turn_rad = 0.0;  ///< of a container that is shifted anywhere, against its slot, >= 0
  double robot_margin_m = 1.0;    ///< between a container that is moved and the robot's body, >= 0
  double people_margin_m = 0.5;   ///< the same of people, >= 0
  double passage_m = 1.4;         ///< width that corridors keep, > 0
  double lanes_kept = 0.95;       ///< share of the floor with such a passage that stays reachable, [0, 1]
  double least_filled = 0.6;      ///< share of slots below which nothing more is removed, [0, 1]
};

class Forklift {
 public:
  /// `slots` are the places where containers stand in order; the initial world fills some of them.
  Forklift(const ForkliftParams& params, std::vector<Box> slots, const World& initial_world, const Point2& robot_start,
           Random random);

  using MayTouch = std::function<bool(const Box& box)>;
  /// The next change of this world, or none where nothing can be done now without harm. `may_touch` is asked of where a
  /// container stands before and after.
  [[nodiscard]] std::optional<Change> next_change(const World& world, const Circle& robot,
                                                  std::span<const Circle> people, const MayTouch& may_touch = {});

  /// Another has done this.
  void learn(const Change& change);

  [[nodiscard]] const ForkliftParams& params() const { return params_; }

 private:
  struct Slot {
    Box home;
    int container = 0;  // id; 0 = empty
  };
  [[nodiscard]] bool is_harmless(const Change& change, const World& world, const ReachableFloor& floor,
                                 const Circle& robot, std::span<const Circle> people) const;
  [[nodiscard]] std::optional<Change> proposed(ChangeKind kind, Slot& slot, const World& world);
  [[nodiscard]] Box shifted(const Box& box, const Box& home);
  void note(const Change& change, Slot& slot);

  ForkliftParams params_;
  std::vector<Slot> slots_;
  ReachableFloor lanes_;  // what must stay reachable
  int next_id_ = 1;
  Random random_;
};

/// Whether someone on the floor stands before a face of the box: from there it is seen, and can be lifted.
[[nodiscard]] bool is_exposed(const Box& box, const ReachableFloor& floor, double clearance_m);

}  // namespace deltamap::simulation
