// SPDX-License-Identifier: Apache-2.0
// Whether the way between scans is as long in the map as the scans say: two passes that see one face of a wall from
// different distances draw it apart by what the way between them is too long or too short. Small beside the noise of
// one pair; over all pairs it is not.
#pragma once

#include <cstddef>
#include <span>

#include "surveying/quality/seen_walls.hpp"

namespace deltamap::surveying::quality {

struct MapScale {
  double error = 0.0;     ///< the map's lengths over the true ones, less 1; 0 where nothing tells
  double lever_m = 0.0;   ///< root mean square of the way between the passes, square to the walls
  std::size_t looks = 0;  ///< ends of beams that tell
};
[[nodiscard]] MapScale map_scale(std::span<const PlacedScan> scans, std::span<const Pass> passes,
                                 const SeenWalls& walls);

}  // namespace deltamap::surveying::quality
