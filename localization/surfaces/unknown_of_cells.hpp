// SPDX-License-Identifier: Apache-2.0
// What the cells of a map leave open of a pose that is found by its surfaces: each surface lies anywhere in the cells
// that it is drawn with, and does so whenever it is seen again.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/geometry/pose2.hpp"

namespace deltamap::localization::surfaces {

/// A surface that a pose rests on.
struct SupportingFace {
  Point2 normal;         ///< map frame
  double cells_m = 0.0;  ///< deviation of the surface in its cells
  double off_m = 0.0;    ///< along the normal: how far it stands from where the map has it
  double weight = 1.0;   ///< as how many it counts, [0, 1]: less where it may have moved, or is a piece of a longer one
};

/// Covariances of the position, map frame, m²; zero where it rests on no surface.
struct UnknownOfCells {
  /// Were each face off its cells in its own way: the error of their mean.
  Eigen::Matrix2d scattered = Eigen::Matrix2d::Zero();
  /// What comes on top where they are off alike, or drawn worse than their cells allow.
  Eigen::Matrix2d alike = Eigen::Matrix2d::Zero();
};

/// In a building whose walls stand at whole cells from each other all are off alike, and a hundred tell no more than
/// one. How they are scattered about the pose tells.
[[nodiscard]] UnknownOfCells unknown_of_cells(std::span<const SupportingFace> faces);

}  // namespace deltamap::localization::surfaces
