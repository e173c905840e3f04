// SPDX-License-Identifier: Apache-2.0
// Which neighbouring beams of a scan meet one face, so that there is no gap between their ends: they end no farther
// apart than on a face that is met at a slant, and the beams beside them on both sides show that the face goes on
// straight.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/geometry/pose2.hpp"

namespace deltamap::mapping::votes {

/// 1 over the sine of the least angle at which a face is met.
inline constexpr double kFaceSlant = 3.0;

/// `visit(i)` for each i whose end and that of beam i + 1, `bearing_step_rad` apart, lie on one face. `length_m(i)`: of
/// the beam, <= 0 where it does not count; `end(i)`: in any one frame.
template <typename Length, typename End, typename Visit>
void for_each_face_step(std::size_t beams, double bearing_step_rad, Length&& length_m, End&& end, Visit&& visit) {
  constexpr double kMostBendRad = 0.45;  // between neighbouring pieces of one face (26°): corners are not cut
  constexpr double kNoise_m = 0.04;      // of the readings and of what they meet
  const auto is_step = [&](std::size_t i) {
    const double a = length_m(i);
    const double b = length_m(i + 1);
    if (a <= 0.0 || b <= 0.0) return false;
    return (end(i + 1) - end(i)).norm() <= kFaceSlant * std::min(a, b) * bearing_step_rad + kNoise_m;
  };
  const auto bend_rad = [&](std::size_t i, std::size_t j) {
    const Point2 a = end(i + 1) - end(i);
    const Point2 b = end(j + 1) - end(j);
    return std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
  };
  for (std::size_t i = 0; i + 1 < beams; ++i) {
    if (!is_step(i)) continue;
    const auto goes_on = [&](std::size_t beside) { return is_step(beside) && bend_rad(i, beside) <= kMostBendRad; };
    if (i > 0 && i + 2 < beams && goes_on(i - 1) && goes_on(i + 1)) visit(i);
  }
}

}  // namespace deltamap::mapping::votes
