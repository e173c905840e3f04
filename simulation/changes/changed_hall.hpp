// SPDX-License-Identifier: Apache-2.0
// A hall of which a share has changed: what many acts of a fork-lift make of it while nobody looks. M_0 is drawn of the
// world before.
#pragma once

#include <span>
#include <vector>

#include "core/random.hpp"
#include "simulation/changes/forklift.hpp"

namespace deltamap::simulation {

/// How a run begins in a hall that is no longer as in the first map.
struct ChangedStartParams {
  double share = 0.5;  ///< of the slots that are not as they were, [0, 1]
  std::vector<ChangeKind> kinds{ChangeKind::kRemoved, ChangeKind::kAdded, ChangeKind::kShifted};
  double smallest_shift_m = 0.3;  ///< > 0
  double largest_shift_m = 0.8;   ///< of a container from its slot, >= smallest_shift_m
  double least_filled = 0.3;      ///< share of slots that stay filled, [0, 1]
};

/// The fork-lift that brings the changes of a start about.
[[nodiscard]] ForkliftParams forklift_for(const ChangedStartParams& start);

struct ChangedHall {
  World world;
  std::vector<Change> changes;  ///< in order
};

/// What limits the acts of a fork-lift that changes a hall at once.
struct HallBounds {
  double share = 0.5;                ///< of the slots that are not as before, [0, 1]
  std::size_t most_acts_a_slot = 4;  ///< > 0
};

/// Acts of a fork-lift on `now` until that share of the slots is not as in `before`. Fewer where no more can be done
/// without harm.
[[nodiscard]] ChangedHall changed_hall(const HallBounds& bounds, const ForkliftParams& forklift,
                                       const std::vector<Box>& slots, const World& before, const World& now,
                                       const Circle& robot, std::span<const Circle> people, Random random);

/// The hall in which a run begins; each container that differs is one change.
[[nodiscard]] ChangedHall changed_start(const ChangedStartParams& params, const std::vector<Box>& slots,
                                        const World& before, const Circle& robot, std::span<const Circle> people,
                                        Random random);

}  // namespace deltamap::simulation
