// SPDX-License-Identifier: Apache-2.0
// Walls that the robot's own way leads through: where it was, none can have stood.
#pragma once

#include <span>
#include <vector>

#include "surveying/quality/seen_walls.hpp"

namespace deltamap::surveying::quality {

/// Places where the robot's middle went through a wall that another pass has seen; those close to one that is named
/// already are left out.
[[nodiscard]] std::vector<Point2> driven_walls(std::span<const PlacedScan> scans, std::span<const Pass> passes,
                                               const SeenWalls& walls);

}  // namespace deltamap::surveying::quality
