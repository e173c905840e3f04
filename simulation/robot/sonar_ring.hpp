// SPDX-License-Identifier: Apache-2.0
// The sixteen sonars of a P3-DX: where each sits and looks (protocols.md A7).
#pragma once

#include "core/geometry/pose2.hpp"

namespace deltamap::simulation {

/// `index` in [0, 16).
[[nodiscard]] Pose2 robot_from_sonar(int index);

}  // namespace deltamap::simulation
