// SPDX-License-Identifier: Apache-2.0
// Leaves out beams that end at transient obstacles: such beams say nothing about the pose and must not pull the
// believed one. Other pose hypotheses are weighed with all beams.
#pragma once

#include <cstddef>

#include "core/transient_obstacles.hpp"
#include "localization/motion/deskew.hpp"

namespace deltamap::localization::sensor {

struct TransientBeamsParams {
  bool weighing = true;           ///< leave such beams out where the believed pose is weighed and refined
  double least_share_left = 0.5;  ///< of a scan's beams: where fewer would be left, all are weighed; 0..1
};

/// `ends` without those that lie on what stands there for now, with the robot at the pose; into the memory of `others`.
[[nodiscard]] motion::BeamEnds lasting_ends(const motion::BeamEnds& ends, const TransientObstacles& transients,
                                            const Pose2& map_from_robot, motion::BeamEnds others);

}  // namespace deltamap::localization::sensor
