// SPDX-License-Identifier: Apache-2.0
// Counts the checked beams of one scan: on proven tiles or elsewhere, and by the direction in which they constrain the
// pose. A corridor's walls constrain it across and say nothing along; a pose must be supported both ways to be
// believed.
#pragma once

#include <array>
#include <span>

#include "core/messages.hpp"
#include "localization/belief/beam_check.hpp"
#include "localization/belief/stability.hpp"

namespace deltamap::localization::belief {

/// Beams in units of what they tell about one direction: a beam counts by the square of its surface's share in it.
struct Support {
  double fit = 0.0;
  double short_of = 0.0;
  double beyond = 0.0;
  [[nodiscard]] double expected() const { return fit + short_of + beyond; }
};

struct ViewTally {
  BeamCounts stable;
  BeamCounts elsewhere;
  std::array<Support, 2> stable_along;     ///< the two principal directions of all surfaces in view
  std::array<Support, 2> elsewhere_along;  ///< the same directions
};

[[nodiscard]] ViewTally tallied(std::span<const CheckedBeam> beams, const Stability& stability);

}  // namespace deltamap::localization::belief
