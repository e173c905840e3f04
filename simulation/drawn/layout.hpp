// SPDX-License-Identifier: Apache-2.0
// Where walls and things stand in a drawn world: seven kinds of buildings, none with a size of its own. Lengths are
// continuous, so that no surface lies on a map's lattice but by chance.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/random.hpp"
#include "simulation/world/world.hpp"

namespace deltamap::simulation::drawn {

enum class LayoutKind : std::uint8_t {
  kBlocks,      ///< of containers, corridors between, as in the paper
  kRackAisles,  ///< rows of racks on posts, goods in them
  kOffices,     ///< rooms on both sides of a corridor
  kCorridors,   ///< that look alike, one beside the other
  kBentHall,    ///< L or U
  kOblique,     ///< outer walls at any angle
  kWideHall     ///< little within reach of a laser
};
inline constexpr std::uint32_t kLayoutKinds = 7;
[[nodiscard]] std::string_view name_of(LayoutKind kind);

struct Layout {
  World world;             ///< the outer wall first, a closed line
  std::vector<Box> slots;  ///< places of things that come, go and are shifted; most of them are filled
  double passage_m = 1.4;  ///< width of the narrowest way that is meant to be driven
};

/// Anywhere in the map frame, and turned where the kind or chance says so. `reach_m`: of the laser; a wide hall is
/// so wide that little of it is within reach, and not so wide that nothing is.
[[nodiscard]] Layout drawn_layout(LayoutKind kind, double reach_m, Random random);

}  // namespace deltamap::simulation::drawn
