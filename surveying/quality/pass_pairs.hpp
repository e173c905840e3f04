// SPDX-License-Identifier: Apache-2.0
// What each pass says of the walls that another has seen: do its beams end on them, or do they go through? A wall that
// stands where another pass saw space contradicts, and so does one that hides what another pass saw behind it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surveying/quality/seen_walls.hpp"

namespace deltamap::surveying::quality {

/// Of the beams that two passes compare, beyond which they contradict each other. Furniture and doors of a good map
/// make 5 %, nine times of ten; walls that stand twice more than half.
inline constexpr double kMostThrough = 0.25;

struct PassPair {
  std::uint32_t one = 0;  ///< passes, one < other
  std::uint32_t other = 0;
  // Beams of either, held against the walls of the other.
  std::uint32_t ended = 0;    ///< on a wall that the other has seen
  std::uint32_t through = 0;  ///< went through one, and ended farther behind than poses and ranges are unsure
  Point2 place{0.0, 0.0};     ///< where they went through, in the middle; map frame
  double depth_m = 0.0;       ///< by which they ended behind the wall, square to it, in the mean

  [[nodiscard]] std::uint32_t compared() const { return ended + through; }
  [[nodiscard]] double through_share() const {
    return compared() == 0 ? 0.0 : static_cast<double>(through) / compared();
  }
};

/// Pairs with at least one beam to compare, ordered by `one`, then `other`.
[[nodiscard]] std::vector<PassPair> pass_pairs(std::span<const PlacedScan> scans, std::span<const Pass> passes,
                                               const SeenWalls& walls);

}  // namespace deltamap::surveying::quality
