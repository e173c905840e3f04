// SPDX-License-Identifier: Apache-2.0
// Scans as a CARMEN log: for tests of what reads recordings.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "core/messages.hpp"

namespace deltamap::test {

/// FLASER lines with the odometry of each scan, half a second apart; the laser sits in the robot's middle.
inline std::string carmen_log(const std::vector<TrackedScan>& scans) {
  std::string log;
  char text[160];
  for (std::size_t i = 0; i < scans.size(); ++i) {
    log += "FLASER " + std::to_string(scans[i].scan.beams.size());
    for (const Beam& beam : scans[i].scan.beams) {
      (void)std::snprintf(text, sizeof text, " %.3f", beam.kind == BeamKind::kRange ? beam.range_m : 81.83F);
      log += text;
    }
    const Pose2& odom = scans[i].odom_from_robot;
    const double time_s = 1000.0 + 0.5 * static_cast<double>(i);
    (void)std::snprintf(text, sizeof text, " %.6f %.6f %.6f %.6f %.6f %.6f %.3f host %.3f\n", odom.x, odom.y,
                        odom.theta, odom.x, odom.y, odom.theta, time_s, time_s);
    log += text;
  }
  return log;
}

}  // namespace deltamap::test
