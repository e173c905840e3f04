// SPDX-License-Identifier: Apache-2.0
// How far the wheels say that the robot has gone from scan to scan; never across a jump of the controller's pose.
#pragma once

#include <cstdint>
#include <optional>

#include "core/messages.hpp"

namespace deltamap::mapping::gate {

class DrivenWay {
 public:
  /// Every scan in order: metres since the last one, 0 where there is none of the same odometry epoch.
  [[nodiscard]] double since_last_m(const TrackedScan& tracked) {
    const bool follows = last_ && epoch_ == tracked.odometry_epoch;
    const double way_m = follows ? distance_between(*last_, tracked.odom_from_robot) : 0.0;
    last_ = tracked.odom_from_robot;
    epoch_ = tracked.odometry_epoch;
    return way_m;
  }

 private:
  std::optional<Pose2> last_;  // odom_from_robot
  std::uint32_t epoch_ = 0;
};

}  // namespace deltamap::mapping::gate
