// SPDX-License-Identifier: Apache-2.0
// How far a trajectory is from reference poses in the map's own frame: no alignment, for a localizer must be right
// there. A pose of the reference that got no estimate counts as lost; in a reference that is denser than the estimates
// each speaks for what lies around it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "simulation/scenario/truth.hpp"
#include "simulation/score/trajectory_score.hpp"

namespace deltamap::simulation::score {

/// Lines `t x y theta` or TUM lines `t x y z qx qy qz qw` (s, m, rad), in order of time afterwards; lines that begin
/// with # are skipped. Of whatever the file tells the poses of. Throws std::runtime_error naming file and line.
[[nodiscard]] std::vector<StampedPose> read_reference(const std::filesystem::path& file);

/// The laser's poses along a trajectory of the robot: for a reference that tells those.
[[nodiscard]] std::vector<StampedPose> laser_poses(std::vector<StampedPose> of_robot, const Pose2& robot_from_laser);

/// What the truth of a simulation says at the times of a trajectory, within its own time.
[[nodiscard]] std::vector<StampedPose> reference_at(const std::vector<StampedPose>& trajectory, const Truth& truth);

/// The poses of a reference, in order of time, within the time of a trajectory: where a part of a drive was asked for,
/// the rest of it is not lost. Empty where there is none.
[[nodiscard]] std::vector<StampedPose> reference_within(const std::vector<StampedPose>& trajectory,
                                                        const std::vector<StampedPose>& reference);

struct ReferenceScore {
  std::size_t matched = 0;  ///< poses of the trajectory within 0.05 s of one of the reference; errors are of these
  std::size_t of = 0;       ///< poses of the reference
  double rmse_m = 0.0;
  double median_m = 0.0;
  double p95_m = 0.0;
  double max_m = 0.0;
  double median_heading_rad = 0.0;
  double p95_heading_rad = 0.0;
  double coverage = 0.0;        ///< share of the reference that got an estimate
  double lost_share = 0.0;      ///< share of the reference that got none within 0.5 m
  double longest_lost_s = 0.0;  ///< the longest such stretch
};

/// Both of the same thing, in one frame; the reference in order of time.
[[nodiscard]] ReferenceScore reference_score(std::vector<StampedPose> trajectory,
                                             const std::vector<StampedPose>& reference);

}  // namespace deltamap::simulation::score
