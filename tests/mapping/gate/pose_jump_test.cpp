// SPDX-License-Identifier: Apache-2.0
// An estimate that moves otherwise than odometry.
#include "mapping/gate/pose_jump.hpp"

#include <gtest/gtest.h>

#include "tests/mapping/straight_drive.hpp"

namespace deltamap::mapping::gate {
namespace {

TEST(PoseJump, SeesACorrectionThatCreepsInOverASecond) {
  StraightDrive robot;
  PoseJump jump{{}};
  for (int i = 0; i < 50; ++i) EXPECT_FALSE(jump.observe(robot.next()));
  bool jumped = false;
  for (int i = 0; i < 10; ++i) {
    robot.map_from_odom.y += 0.06;
    jumped = jump.observe(robot.next()) || jumped;
  }
  EXPECT_TRUE(jumped);
}

TEST(PoseJump, LetsASpreadPoseMoveAndASlowDriftPass) {
  StraightDrive robot;
  PoseJump jump{{}};
  for (int i = 0; i < 600; ++i) {
    robot.map_from_odom.y += 0.004;  // 4 cm a second, as bad wheels may
    EXPECT_FALSE(jump.observe(robot.next()));
  }
  TrackedScan spread = robot.next();
  spread.estimate.covariance *= 400.0;  // 0.4 m
  spread.estimate.map_from_robot.y += 0.9;
  EXPECT_FALSE(jump.observe(spread));
}

TEST(PoseJump, BeginsAnewWithTheOdometry) {
  StraightDrive robot;
  PoseJump jump{{}};
  for (int i = 0; i < 50; ++i) (void)jump.observe(robot.next());
  TrackedScan reset = robot.next();
  reset.odom_from_robot = {};
  reset.odometry_epoch = 1;
  EXPECT_FALSE(jump.observe(reset));
}

}  // namespace
}  // namespace deltamap::mapping::gate
