// SPDX-License-Identifier: Apache-2.0
// Beams that end at what is known to stand there only for now say nothing about where the robot is: they do not pull
// the believed pose. Nothing is ever localized on such things, and other places are weighed with all beams.
#pragma once

#include <cstddef>

#include "core/temporary_things.hpp"
#include "localization/motion/deskew.hpp"

namespace deltamap::localization::sensor {

struct TemporaryBeamsParams {
  bool weighing = true;  ///< leave such beams out where the believed pose is weighed and slid
  /// And where beams speak for or against it. Off: at a wrong pose all that is seen looks temporary, and who leaves it
  /// out notices later.
  bool belief = false;
  double least_share_left = 0.5;  ///< of a scan's beams: where fewer would be left, all are weighed; 0..1
};

/// `ends` without those that lie on what stands there for now, with the robot at the pose; into the memory of `others`.
[[nodiscard]] motion::BeamEnds lasting_ends(const motion::BeamEnds& ends, const TemporaryThings& things,
                                            const Pose2& map_from_robot, motion::BeamEnds others);

}  // namespace deltamap::localization::sensor
