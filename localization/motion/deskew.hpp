// SPDX-License-Identifier: Apache-2.0
// Takes the robot's motion during a sweep out of a scan: each beam becomes a ray in the robot's frame at Scan::time.
// The ends of the beams with a range are what scores a pose.
#pragma once

#include <cstddef>
#include <vector>

#include "core/messages.hpp"
#include "localization/motion/odometry_buffer.hpp"

namespace deltamap::localization::motion {

/// Where the laser is so long after Scan::time, in the robot's frame at Scan::time, for a robot that keeps its
/// velocity.
[[nodiscard]] Point2 laser_at(const Pose2& robot_from_laser, const BodyVelocity& velocity, double offset_s);

/// One ray a beam, for a robot that keeps its velocity during the sweep.
[[nodiscard]] std::vector<RayInRobot> deskewed(const Scan& scan, const BodyVelocity& velocity);

/// The ends of the beams that score, robot frame at Scan::time; a structure of arrays for the weighing kernel.
struct BeamEnds {
  std::vector<float> x_m;
  std::vector<float> y_m;
  double range_deviation_m = kRangeDeviationM;  ///< Scan::range_deviation_m
  [[nodiscard]] std::size_t size() const { return x_m.size(); }
};

/// Those of `ends` for which `is_kept(end)` holds, in their order; `kept` may be `ends` itself.
template <typename IsKept>
void keep_ends(const BeamEnds& ends, IsKept is_kept, BeamEnds& kept) {
  kept.x_m.resize(ends.size());
  kept.y_m.resize(ends.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (!is_kept(Point2{ends.x_m[i], ends.y_m[i]})) continue;
    kept.x_m[count] = ends.x_m[i];
    kept.y_m[count] = ends.y_m[i];
    ++count;
  }
  kept.x_m.resize(count);
  kept.y_m.resize(count);
  kept.range_deviation_m = ends.range_deviation_m;
}

/// Only beams with a valid range score; of these `beams` are taken evenly (0 = all). Reuses the memory of `ends`.
[[nodiscard]] BeamEnds scoring_ends(const Scan& scan, const std::vector<RayInRobot>& rays, int beams,
                                    BeamEnds ends = {});

}  // namespace deltamap::localization::motion
