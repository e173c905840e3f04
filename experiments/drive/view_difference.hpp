// SPDX-License-Identifier: Apache-2.0
// How much of what a laser sees differs between two worlds: by how many of its beams end on something else.
#pragma once

#include "core/geometry/pose2.hpp"
#include "simulation/world/ray_caster.hpp"

namespace deltamap::experiments {

/// Of 181 beams over 180°, the share whose ranges, cut at `max_range_m`, differ by more than 0.25 m.
[[nodiscard]] double differing_share(const simulation::RayCaster& one, const simulation::RayCaster& other,
                                     const Pose2& map_from_laser, double max_range_m);

}  // namespace deltamap::experiments
