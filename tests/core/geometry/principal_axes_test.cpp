// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/principal_axes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace deltamap {
namespace {

TEST(PrincipalAxes, OfATurnedEllipseAreItsOwnTheShortOneFirst) {
  for (const double angle_rad : {0.0, 0.4, 1.2, 2.9}) {
    const Eigen::Vector2d along{std::cos(angle_rad), std::sin(angle_rad)};
    const Eigen::Vector2d across{-along.y(), along.x()};
    const Eigen::Matrix2d matrix = 4.0 * along * along.transpose() + 0.25 * across * across.transpose();
    const PrincipalAxes axes = principal_axes(matrix);
    EXPECT_NEAR(axes.values[0], 0.25, 1e-12);
    EXPECT_NEAR(axes.values[1], 4.0, 1e-12);
    EXPECT_NEAR(std::abs(axes.vectors.col(0).dot(across)), 1.0, 1e-12);
    EXPECT_NEAR(std::abs(axes.vectors.col(1).dot(along)), 1.0, 1e-12);
  }
}

TEST(PrincipalAxes, OfALineHaveNoWidth) {
  const Eigen::Vector2d along{0.6, 0.8};
  const PrincipalAxes axes = principal_axes(along * along.transpose());
  EXPECT_NEAR(axes.values[0], 0.0, 1e-15);
  EXPECT_NEAR(axes.values[1], 1.0, 1e-15);
}

}  // namespace
}  // namespace deltamap
