// SPDX-License-Identifier: Apache-2.0
#include "surveying/grid_registration/motion_equations.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace deltamap::surveying::grid_registration {
namespace {

TEST(MotionEquations, AreSolvedAlongTheAxesThatTheyObserve) {
  MotionEquations sums;
  sums.matrix = Eigen::Vector3d{4.0, 1e-6, 2.0}.asDiagonal();
  sums.right_side = {8.0, 5.0, 2.0};
  EXPECT_TRUE(observed_step(sums).isApprox(Eigen::Vector3d{2.0, 0.0, 1.0}, 1e-9));
  sums.matrix(1, 1) = 1.0;
  EXPECT_TRUE(observed_step(sums).isApprox(Eigen::Vector3d{2.0, 5.0, 1.0}, 1e-9));
}

TEST(MotionEquations, AnswerNoStepWhereTheyObserveNothing) {
  EXPECT_EQ(observed_step({}), Eigen::Vector3d(0.0, 0.0, 0.0));
}

TEST(MotionEquations, CountATurnAsWhatItMovesACellAtTheLeverArm) {
  const std::vector<EdgeCell> edges{{{3.0F, 4.0F}}, {{-3.0F, 4.0F}}, {{0.0F, -5.0F}}};
  EXPECT_NEAR(lever_of(edges), 5.0, 1e-6);
  EXPECT_EQ(lever_of({}), 1.0);
  EXPECT_EQ(moved({0.1, 10.0, 20.0}, {0.5, -0.5, 1.0}, 5.0), (mapping::merge::CellMotion{0.1 + 0.2, 10.5, 19.5}));
}

}  // namespace
}  // namespace deltamap::surveying::grid_registration
