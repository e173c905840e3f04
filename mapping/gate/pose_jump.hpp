// SPDX-License-Identifier: Apache-2.0
// Detects that the estimate has jumped: over the last seconds it has moved otherwise than odometry by more than both
// covariances explain. One of the two poses was wrong, or the wheels have slipped far.
#pragma once

#include <deque>

#include "core/angle.hpp"
#include "core/messages.hpp"

namespace deltamap::mapping::gate {

struct PoseJumpParams {
  double window_s = 3.0;             ///< over which the two are compared, s; > 0
  double least_m = 0.25;             ///< a smaller difference is none, m; > 0
  double least_rad = radians(12.0);  ///< a smaller difference of heading is none, rad; > 0
  double per_metre = 0.05;           ///< more is allowed for each metre driven: wheels are not exact; >= 0
  double rad_per_rad = 0.1;          ///< more of heading for each radian turned; >= 0
  double deviations = 3.0;           ///< σ of both estimates that are allowed besides; >= 0
};

class PoseJump {
 public:
  explicit PoseJump(const PoseJumpParams& params) : params_{params} {}

  /// Every scan in order: has the estimate jumped within the window? Told once; the comparison begins anew then.
  [[nodiscard]] bool observe(const TrackedScan& tracked);

 private:
  struct Sample {
    Timestamp time;
    Pose2 map_from_robot;
    Pose2 odom_from_robot;
    double position_deviation_m = 0.0;
    double heading_deviation_rad = 0.0;
    double driven_m = 0.0;
    double turned_rad = 0.0;
  };

  PoseJumpParams params_;
  std::deque<Sample> samples_;  // of one odometry epoch, oldest first
  std::uint32_t epoch_ = 0;
};

}  // namespace deltamap::mapping::gate
