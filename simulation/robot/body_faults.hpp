// SPDX-License-Identifier: Apache-2.0
// What goes wrong between wheels and floor, on order. Everything at its default: nothing.
#pragma once

#include "core/geometry/pose2.hpp"

namespace deltamap::simulation {

struct BodyFaults {
  // Share of the way that a wheel's encoder counts by which the wheel moves the body: 0 it spins, 1 as it should be,
  // more than 1 the body slides on.
  double left_grip = 1.0;
  double right_grip = 1.0;
  /// Neither wheel turns, whatever the motors are told; no stall is reported.
  bool wheels_blocked = false;
  bool counts_nothing = false;  ///< its wheels turn and move the body, its encoders stand
  double pushed_m_per_s = 0.0;  ///< ahead, and its wheels roll along and count it, whatever the motors are told
  Pose2 towed_per_s{};          ///< the body is carried on, m/s and rad/s in its own frame; the wheels notice nothing

  friend bool operator==(const BodyFaults&, const BodyFaults&) = default;
};

}  // namespace deltamap::simulation
