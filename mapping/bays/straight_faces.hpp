// SPDX-License-Identifier: Apache-2.0
// Straight faces among the ends of beams: what tells a load from people, whose fronts are round and narrow, in one scan
// already. Split at the farthest point (Ramer 1972), then held against a line of least squares.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry/pose2.hpp"

namespace deltamap::mapping::bays {

/// [first, last) of the points.
struct StraightFace {
  std::size_t first = 0;
  std::size_t last = 0;
};

/// Ends of beams that follow each other, metres, in any frame. Faces that are longer than a person is wide, in order.
[[nodiscard]] std::vector<StraightFace> straight_faces(std::span<const Point2> ends);

}  // namespace deltamap::mapping::bays
