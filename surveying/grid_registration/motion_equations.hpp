// SPDX-License-Identifier: Apache-2.0
// Least squares of a small motion of a local map. A turn counts as what it moves a cell at the lever arm, so that all
// three unknowns are cells.
#pragma once

#include <Eigen/Core>
#include <span>

#include "surveying/grid_registration/edge_registration.hpp"

namespace deltamap::surveying::grid_registration {

inline constexpr int kLeastPaired = 20;  ///< cells that a motion can be told from

struct MotionEquations {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  int paired = 0;  ///< cells that they were summed over
};

/// The step along the axes that the cells tell of.
[[nodiscard]] Eigen::Vector3d observed_step(const MotionEquations& sums);

/// How far a turn of 1 rad moves the edges, root mean square.
[[nodiscard]] double lever_of(std::span<const EdgeCell> edges);

[[nodiscard]] inline mapping::merge::CellMotion moved(const mapping::merge::CellMotion& motion,
                                                      const Eigen::Vector3d& step, double lever_cells) {
  return {motion.turn_rad + step.z() / lever_cells, motion.column + step.x(), motion.row + step.y()};
}

}  // namespace deltamap::surveying::grid_registration
