// SPDX-License-Identifier: Apache-2.0
// The axes of the ellipse that a symmetric 2 × 2 matrix describes. Compiled once: Eigen's solver costs seconds in each
// source that names it.
#pragma once

#include <Eigen/Core>

namespace deltamap {

struct PrincipalAxes {
  Eigen::Vector2d values;   ///< eigenvalues, the smaller one first
  Eigen::Matrix2d vectors;  ///< their unit vectors, one a column
};

/// Reads the lower triangle of the matrix alone.
[[nodiscard]] PrincipalAxes principal_axes(const Eigen::Matrix2d& symmetric);

}  // namespace deltamap
