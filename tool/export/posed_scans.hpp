// SPDX-License-Identifier: Apache-2.0
// The scans of a recording with where the wheels have the robot, for those who want no bytes.
#pragma once

#include <functional>
#include <string>

#include "core/messages.hpp"
#include "daemon/settings/settings.hpp"
#include "drivers/port/log_faults.hpp"

namespace deltamap::tool {

/// Poses are in one frame over all epochs of the odometry; a jump between two counts as standing still.
struct PosedScanSinks {
  std::function<void(const Odometry&, const Pose2& odom_from_robot)> odometry;
  /// At the scan's first beam; the origin before the first odometry.
  std::function<void(const Scan&, const Pose2& odom_from_robot)> scan;
};

/// Answers what the recording lacks. Throws std::runtime_error as ReplayPort does, and where nothing is in it.
drivers::port::LogFaults read_posed_scans(const std::string& recording, const daemon::Settings& settings,
                                          const PosedScanSinks& sinks);

}  // namespace deltamap::tool
