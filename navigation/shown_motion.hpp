// SPDX-License-Identifier: Apache-2.0
// How much of a motion two scans show: the wheels say that the robot has moved, and what was seen before should have
// moved with it. Asks only of what would look different: a long corridor looks the same a metre further on, and says
// nothing.
#pragma once

#include "core/messages.hpp"

namespace deltamap::navigation {

/// What is the same of two scans and two motions.
struct Likeness {
  double same_m = 0.06;           ///< of two ranges: noise, motion within the sweep, slant between two beams
  double same_per_m = 0.005;      ///< and so much more for each metre of range
  double turned_more_rad = 0.09;  ///< wheels that report a tenth of a second late misjudge a turn by so much
  /// Of a robot so slow that there is hardly more than noise.
  [[nodiscard]] static Likeness creeping() { return {.same_m = 0.025, .same_per_m = 0.0025, .turned_more_rad = 0.03}; }
};

struct ShownMotion {
  int asked = 0;           ///< ends of the first scan that should be seen elsewhere, if the robot has moved as told
  double as_told = 0.0;    ///< share of these that are, for the best of 0.75 to 1.25 times the motion; [0, 1]
  double otherwise = 0.0;  ///< share of these that show where a standing robot, one that moves backwards, or one whose
                           ///< laser is turned on its mount by 90° or 180° would see them: the best of these; [0, 1]
  double askew = 0.0;  ///< the same of a laser that is turned by 45° or 135°; after a decimetre this is like as_told
};

/// `robot_before_from_after`: the motion that the wheels tell from one scan to the other.
[[nodiscard]] ShownMotion shown_motion(const Scan& before, const Scan& after, const Pose2& robot_before_from_after,
                                       const Likeness& likeness = {});

}  // namespace deltamap::navigation
