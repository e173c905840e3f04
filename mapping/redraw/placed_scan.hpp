// SPDX-License-Identifier: Apache-2.0
// A scan and the pose that it is drawn from.
#pragma once

#include "core/messages.hpp"

namespace deltamap::mapping::redraw {

struct PlacedScan {
  const TrackedScan* tracked = nullptr;
  Pose2 map_from_robot;
};

}  // namespace deltamap::mapping::redraw
