// SPDX-License-Identifier: Apache-2.0
// How much of a motion two scans show: the wheels say that the robot has moved, and what was seen before should have
// moved with it. Asks only of what would look different: a long corridor looks the same a metre further on, and says
// nothing.
#pragma once

#include "core/messages.hpp"

namespace deltamap::navigation {

struct ShownMotion {
  int asked = 0;           ///< ends of the first scan that should be seen elsewhere, if the robot has moved as told
  double as_told = 0.0;    ///< share of these that are, for the best of 0.75 to 1.25 times the motion; [0, 1]
  double otherwise = 0.0;  ///< share of these that show where a standing robot, or one that moves backwards, would see
                           ///< them: the best of -1 to 0.25 times the motion; [0, 1]
};

/// `robot_before_from_after`: the motion that the wheels tell from one scan to the other.
[[nodiscard]] ShownMotion shown_motion(const Scan& before, const Scan& after, const Pose2& robot_before_from_after);

}  // namespace deltamap::navigation
