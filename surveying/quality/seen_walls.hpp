// SPDX-License-Identifier: Apache-2.0
// Which passes have seen a wall where: cells in which beams of several of a pass's scans ended on a straight surface.
// One table for all passes, so that a beam that is held against them walks its way once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/grid/tiled.hpp"
#include "surveying/quality/passes.hpp"

namespace deltamap::surveying::quality {

inline constexpr double kWallCellM = 0.1;
inline constexpr double kLongestSeenM = 25.0;  ///< as far as maps are drawn: beyond, neighbouring beams leave cells out

class SeenWalls {
 public:
  struct Wall {
    std::uint32_t pass = 0;
    Eigen::Vector2f normal{0.0F, 0.0F};  ///< map frame, unit length, to the side that it was seen from
  };

  SeenWalls(std::span<const PlacedScan> scans, std::span<const Pass> passes);

  [[nodiscard]] const GridGeometry& geometry() const { return geometry_; }
  /// By the passes that have seen a wall in the cell; it may lie outside the geometry.
  [[nodiscard]] std::span<const Wall> at(Cell cell) const {
    if (!geometry_.contains(cell)) return {};
    const std::uint32_t place = place_[cell];
    if (place == 0) return {};
    return {walls_.data() + begins_[place - 1], walls_.data() + begins_[place]};
  }

 private:
  GridGeometry geometry_;
  Tiled<std::uint32_t> place_;         // in begins_, counted from 1; 0: no wall
  std::vector<std::uint32_t> begins_;  // in walls_, one more than cells that have any
  std::vector<Wall> walls_;
};

}  // namespace deltamap::surveying::quality
