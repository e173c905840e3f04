// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/principal_axes.hpp"

#include <Eigen/Eigenvalues>

namespace deltamap {

PrincipalAxes principal_axes(const Eigen::Matrix2d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solved{symmetric};
  return {solved.eigenvalues(), solved.eigenvectors()};
}

}  // namespace deltamap
