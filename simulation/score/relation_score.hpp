// SPDX-License-Identifier: Apache-2.0
// How well a trajectory agrees with measured relations between its poses, whatever frame it has: Kümmerle et al., "On
// measuring the accuracy of SLAM algorithms", 2009, Eq. 5. A relation counts the same wherever in the drive it lies, so
// that one early error does not count in all that follows.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "simulation/score/trajectory_score.hpp"

namespace deltamap::simulation::score {

/// Where the robot was at the second time, as seen from where it was at the first.
struct Relation {
  Timestamp first;
  Timestamp second;
  Pose2 first_from_second;
};

/// Lines `t1 t2 x y z roll pitch yaw` (s, m, rad), as the authors publish them; lines that begin with # are skipped.
/// Throws std::runtime_error naming file and line.
[[nodiscard]] std::vector<Relation> read_relations(const std::filesystem::path& file);

/// Mean and standard deviation over the relations.
struct MeanAndDeviation {
  double mean = 0.0;
  double deviation = 0.0;
};

struct RelationScore {
  std::size_t relations = 0;  ///< both times lie within the trajectory, not in a gap of 5 s; all figures are of these
  std::size_t outside = 0;    ///< the others
  MeanAndDeviation translation_m;    ///< absolute errors
  MeanAndDeviation translation2_m2;  ///< squared errors
  MeanAndDeviation rotation_rad;
  MeanAndDeviation rotation2_rad2;
};

/// Poses between two of the trajectory, in order of time, are interpolated.
[[nodiscard]] RelationScore relation_score(std::vector<StampedPose> trajectory, const std::vector<Relation>& relations);

}  // namespace deltamap::simulation::score
