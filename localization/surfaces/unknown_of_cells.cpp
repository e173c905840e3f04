// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/unknown_of_cells.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace deltamap::localization::surfaces {
namespace {

/// How far a surface stands from where the map has it.
double off_m(const SurfaceSwitch& of, const OffsetState& state, std::size_t surface) {
  return state.mean()[OffsetState::offset_of(surface)] - of.usual_m;
}

}  // namespace

UnknownOfCells unknown_of_cells(std::span<const SurfaceSwitch> switches, const OffsetState& state) {
  Eigen::Matrix2d faces = Eigen::Matrix2d::Zero();
  Point2 pull{0.0, 0.0};
  double cells_m2 = 0.0;  // what one surface leaves open
  for (std::size_t i = 0; i < switches.size(); ++i) {
    const Surface& surface = switches[i].surface;
    const Point2 counted = switches[i].holds * switches[i].share * surface.normal;
    cells_m2 = std::max(cells_m2, surface.offset_deviation_m * surface.offset_deviation_m);
    faces += counted * surface.normal.transpose();
    pull += counted * off_m(switches[i], state, i);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes{faces};
  const Point2 counts = axes.eigenvalues().cwiseMax(1.0);  // faces that tell of each direction
  const Point2 common_m = axes.eigenvectors() * (axes.eigenvectors().transpose() * pull).cwiseQuotient(counts);

  // The two that the position takes up count as scattered like cells.
  constexpr double kOfPosition = 2.0;
  double scatter_m2 = kOfPosition * cells_m2;
  for (std::size_t i = 0; i < switches.size(); ++i) {
    const double own_m = off_m(switches[i], state, i) - switches[i].surface.normal.dot(common_m);
    scatter_m2 += switches[i].holds * switches[i].share * own_m * own_m;
  }
  scatter_m2 /= std::max(kOfPosition, faces.trace());

  const double alike_m2 = std::max(0.0, cells_m2 - scatter_m2);
  const double worse_m2 = std::max(0.0, scatter_m2 - cells_m2);
  const auto along_axes = [&](const Point2& variances_m2) -> Eigen::Matrix2d {
    return axes.eigenvectors() * variances_m2.asDiagonal() * axes.eigenvectors().transpose();
  };
  const Point2 shares = counts.cwiseInverse();
  return {along_axes(cells_m2 * shares), along_axes(worse_m2 * shares + alike_m2 * (Point2::Ones() - shares))};
}

}  // namespace deltamap::localization::surfaces
