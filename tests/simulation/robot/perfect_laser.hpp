// SPDX-License-Identifier: Apache-2.0
// A laser in the robot's middle that measures without noise and misses nothing.
#pragma once

#include "simulation/robot/range_finder.hpp"

namespace deltamap::simulation {

[[nodiscard]] inline RangeFinderParams perfect_laser() {
  RangeFinderParams params;
  params.robot_from_laser = {};
  params.range_noise_m = params.dropout_share = params.mixed_share = 0.0;
  return params;
}

}  // namespace deltamap::simulation
