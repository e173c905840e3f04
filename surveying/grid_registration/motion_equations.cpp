// SPDX-License-Identifier: Apache-2.0
#include "surveying/grid_registration/motion_equations.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace deltamap::surveying::grid_registration {

Eigen::Vector3d observed_step(const MotionEquations& sums) {
  constexpr double kLeastObserved = 0.002;  // share of the best axis' curvature
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes{sums.matrix};
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double curvature = axes.eigenvalues()[i];
    if (curvature <= kLeastObserved * axes.eigenvalues()[2]) continue;
    const Eigen::Vector3d axis = axes.eigenvectors().col(i);
    step += axis.dot(sums.right_side) / curvature * axis;
  }
  return step;
}

double lever_of(std::span<const EdgeCell> edges) {
  double squares = 0.0;
  for (const EdgeCell& edge : edges) squares += edge.at.x * edge.at.x + edge.at.y * edge.at.y;
  return std::max(1.0, std::sqrt(squares / std::max(1.0, static_cast<double>(edges.size()))));
}

}  // namespace deltamap::surveying::grid_registration
