// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/unknown_of_cells.hpp"

#include <algorithm>

#include "core/geometry/principal_axes.hpp"

namespace deltamap::localization::surfaces {

UnknownOfCells unknown_of_cells(std::span<const SupportingFace> faces) {
  Eigen::Matrix2d normals = Eigen::Matrix2d::Zero();
  Point2 pull{0.0, 0.0};
  double cells_m2 = 0.0;  // what one surface leaves open
  for (const SupportingFace& face : faces) {
    const Point2 counted = face.weight * face.normal;
    cells_m2 = std::max(cells_m2, face.cells_m * face.cells_m);
    normals += counted * face.normal.transpose();
    pull += counted * face.off_m;
  }
  const PrincipalAxes axes = principal_axes(normals);
  const Point2 counts = axes.values.cwiseMax(1.0);  // faces that tell of each direction
  const Point2 common_m = axes.vectors * (axes.vectors.transpose() * pull).cwiseQuotient(counts);

  // The two that the position takes up count as scattered like cells.
  constexpr double kOfPosition = 2.0;
  double scatter_m2 = kOfPosition * cells_m2;
  for (const SupportingFace& face : faces) {
    const double own_m = face.off_m - face.normal.dot(common_m);
    scatter_m2 += face.weight * own_m * own_m;
  }
  scatter_m2 /= std::max(kOfPosition, normals.trace());

  const double alike_m2 = std::max(0.0, cells_m2 - scatter_m2);
  const double worse_m2 = std::max(0.0, scatter_m2 - cells_m2);
  const auto along_axes = [&](const Point2& variances_m2) -> Eigen::Matrix2d {
    return axes.vectors * variances_m2.asDiagonal() * axes.vectors.transpose();
  };
  const Point2 shares = counts.cwiseInverse();
  return {along_axes(cells_m2 * shares), along_axes(worse_m2 * shares + alike_m2 * (Point2::Ones() - shares))};
}

}  // namespace deltamap::localization::surfaces
