// SPDX-License-Identifier: Apache-2.0
// Where the odometry of a log begins anew: a pose so far from the one before that no robot has driven there. From there
// on the poses are laid on the one before, instead of being drawn as a drive.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/time.hpp"

namespace deltamap::drivers::carmen {

struct LoggedPose {
  std::size_t line = 0;
  Timestamp time;
  Pose2 odom_from_robot;
};

/// From this line of the log on `odom_from_log` leads from its poses to those that go on without a jump.
struct OdometryReset {
  std::size_t line = 0;
  Pose2 odom_from_log;
};

/// By line; the poses are those of the log, in its order.
[[nodiscard]] std::vector<OdometryReset> resets_in(std::span<const LoggedPose> poses);

/// The pose of a line as it goes on.
[[nodiscard]] Pose2 without_resets(std::span<const OdometryReset> resets, std::size_t line, const Pose2& pose);

/// One line; "" without resets.
[[nodiscard]] std::string resets_line(std::span<const OdometryReset> resets);
/// One line of the laser's poses, which a map is drawn at as they are; "" without jumps.
[[nodiscard]] std::string laser_jumps_line(std::span<const OdometryReset> jumps);

}  // namespace deltamap::drivers::carmen
