// SPDX-License-Identifier: Apache-2.0
#include "mapping/alignment/sparse_cholesky.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace deltamap::mapping::alignment {
namespace {

TEST(SparseCholesky, EqualsTheDenseSolutionAndRefusesWhatIsNotPositive) {
  SparseCholesky cholesky;
  const Eigen::Matrix3d diagonal = Eigen::Vector3d{4.0, 5.0, 6.0}.asDiagonal();
  const Eigen::Matrix3d beside = Eigen::Matrix3d::Constant(0.5);
  ASSERT_TRUE(cholesky.factorize(2, {{0, 0, diagonal}, {1, 1, diagonal}, {1, 0, beside}, {1, 1, diagonal}}));
  Eigen::MatrixXd dense(6, 6);
  dense << diagonal, beside.transpose(), beside, 2.0 * diagonal;
  const Eigen::VectorXd right_side = Eigen::VectorXd::LinSpaced(6, 1.0, 6.0);
  EXPECT_LT((cholesky.solve(right_side) - dense.inverse() * right_side).norm(), 1e-12);
  EXPECT_FALSE(cholesky.factorize(1, {{0, 0, -diagonal}}));
}

}  // namespace
}  // namespace deltamap::mapping::alignment
