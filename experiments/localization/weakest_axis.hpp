// SPDX-License-Identifier: Apache-2.0
// Along which direction a scan tells least about where it was taken: in a corridor, along it.
#pragma once

#include "simulation/world/ray_caster.hpp"

namespace deltamap::experiments {

struct WeakestAxis {
  Point2 direction{1.0, 0.0};  ///< unit vector, map frame
  double share = 0.0;          ///< information along it of that across it, [0, 1]; 0: the axis is unobserved altogether
};

/// From the Fisher information of the true scan at the true pose: each beam of 181 that meets a surface within
/// max_range_m tells the distance from that surface, all equally well. The heading is not known either.
[[nodiscard]] WeakestAxis weakest_axis(const simulation::World& world, const simulation::RayCaster& surfaces,
                                       const Pose2& map_from_laser, double max_range_m);

}  // namespace deltamap::experiments
