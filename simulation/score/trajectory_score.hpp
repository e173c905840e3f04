// SPDX-License-Identifier: Apache-2.0
// How far a trajectory is from the truth of a simulation: paper Eq. 12 for every scan.
#pragma once

#include <filesystem>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/time.hpp"
#include "simulation/scenario/truth.hpp"

namespace deltamap::simulation::score {

struct StampedPose {
  Timestamp time;
  Pose2 map_from_robot;
};

/// TUM lines `t x y z qx qy qz qw`; lines that begin with # are skipped. Throws std::runtime_error naming file and
/// line.
[[nodiscard]] std::vector<StampedPose> read_trajectory(const std::filesystem::path& tum_file);

struct TrajectoryScore {
  std::size_t poses = 0;  ///< within the time of the truth
  double median_m = 0.0;
  double p95_m = 0.0;
  double max_m = 0.0;
  double share_beyond_half_metre = 0.0;  ///< of poses more than 0.5 m off
  double median_heading_rad = 0.0;
};

/// Poses outside of the truth's time are left out.
[[nodiscard]] TrajectoryScore trajectory_score(const std::vector<StampedPose>& trajectory, const Truth& truth);

}  // namespace deltamap::simulation::score
