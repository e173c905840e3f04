// SPDX-License-Identifier: Apache-2.0
// Angles in radians, wrapped to (-π, π].
#pragma once

#include <cmath>
#include <numbers>

namespace deltamap {

[[nodiscard]] constexpr double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }
[[nodiscard]] constexpr double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

/// The same direction in (-π, π].
[[nodiscard]] inline double wrapped_angle(double angle_rad) {
  constexpr double kPi = std::numbers::pi;
  if (angle_rad > -kPi && angle_rad <= kPi) return angle_rad;
  // A little too far the difference is exact (Sterbenz), and much faster than the remainder.
  if (angle_rad > kPi && angle_rad < 2.5 * kPi) return angle_rad - 2.0 * kPi;
  if (angle_rad < -kPi && angle_rad > -2.5 * kPi) return angle_rad + 2.0 * kPi;
  const double wrapped = std::remainder(angle_rad, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

/// The shortest turn that leads from one direction to another, in (-π, π].
[[nodiscard]] inline double turn_between(double from_rad, double to_rad) { return wrapped_angle(to_rad - from_rad); }

}  // namespace deltamap
