// SPDX-License-Identifier: Apache-2.0
#include "simulation/robot/robot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace deltamap::simulation {
namespace {

constexpr double kBodyStep_s = 0.005;

RobotParams perfect_body() {
  RobotParams params;
  params.track_error = params.left_wheel_error = params.right_wheel_error = 0.0;
  params.wheel_noise_m_per_sqrt_m = params.slips_per_m = 0.0;
  return params;
}

const RayCaster& empty_hall() {
  static const RayCaster caster{
      World{{{1, ObjectKind::kWall, Polyline{{{0, 0}, {20, 0}, {20, 20}, {0, 20}, {0, 0}}}}}}};
  return caster;
}

void drive(Robot& robot, double speed, double turn_rate, double seconds, std::span<const Circle> people = {}) {
  for (int i = 0; i < static_cast<int>(std::lround(seconds / kBodyStep_s)); ++i) {
    robot.move({.speed_m_per_s = speed, .turn_rate_rad_per_s = turn_rate}, kBodyStep_s, empty_hall(), people);
  }
}

TEST(Robot, TakesTheTimeThatItsAccelerationNeeds) {
  Robot robot{perfect_body(), {10, 10, 0}, Random{1}};
  drive(robot, 0.6, 0.0, 1.0);
  EXPECT_NEAR(robot.state().speed_m_per_s, 0.3, 1e-9) << "0.3 m/s² for a second";
  drive(robot, 0.6, 0.0, 2.0);
  EXPECT_NEAR(robot.state().speed_m_per_s, 0.6, 1e-9);
  drive(robot, 0.0, 0.0, 2.0);
  EXPECT_NEAR(robot.state().map_from_robot.x, 10 + 0.6 + 0.6 + 0.6, 0.01) << "up 0.6 m, a second at speed, down 0.6 m";
}

TEST(Robot, DrivesACircleWithoutErrorsAndItsEncodersAgree) {
  Robot robot{perfect_body(), {10, 5, 0}, Random{1}};
  drive(robot, 0.5, 0.25, 60.0);  // a radius of 2 m
  const Pose2 expected = Pose2{10, 5, 0} * robot.state().odom_from_robot;
  EXPECT_NEAR(distance_between(robot.state().map_from_robot, expected), 0.0, 1e-9);
  const Point2 centre = robot.state().map_from_robot * Point2{0.0, 2.0};
  drive(robot, 0.5, 0.25, 7.0);
  EXPECT_NEAR((robot.state().map_from_robot * Point2{0.0, 2.0} - centre).norm(), 0.0, 1e-3);
}

TEST(Robot, DriftsFromItsEncodersByItsWheelErrorsAndRepeatsFromItsSeed) {
  RobotParams params = perfect_body();
  params.left_wheel_error = 0.02;
  Robot biased{params, {10, 10, 0}, Random{1}};
  drive(biased, 0.5, 0.0, 10.0);
  EXPECT_LT(biased.state().map_from_robot.theta, -0.1) << "the larger left wheel turns it to the right";
  EXPECT_NEAR(biased.state().odom_from_robot.theta, 0.0, 1e-12) << "and its encoders do not know";

  const auto end_from_seed = [](std::uint64_t seed) {
    Robot robot{RobotParams{}, {10, 10, 0}, Random{seed}};
    drive(robot, 0.4, 0.3, 20.0);
    return robot.state().map_from_robot;
  };
  EXPECT_EQ(end_from_seed(3), end_from_seed(3));
  EXPECT_NE(end_from_seed(3), end_from_seed(4));
}

TEST(Robot, LosesTravelWhereAWheelSlips) {
  RobotParams params = perfect_body();
  params.slips_per_m = 2.0;
  Robot robot{params, {2, 10, 0}, Random{9}};
  drive(robot, 0.5, 0.0, 20.0);
  const double encoders_m = robot.state().odom_from_robot.x;
  const double travelled_m = distance_between(robot.state().map_from_robot, {2, 10, 0});
  EXPECT_LT(travelled_m, 0.99 * encoders_m);
}

TEST(Robot, StopsAtAWallStallsAndCanTurnAndLeave) {
  Robot robot{perfect_body(), {18, 10, 0}, Random{1}};
  drive(robot, 0.5, 0.0, 10.0);
  EXPECT_NEAR(robot.state().map_from_robot.x, 20.0 - 0.25, 0.01);
  EXPECT_LE(robot.state().map_from_robot.x, 20.0 - 0.25 + 1e-9) << "never inside the wall";
  EXPECT_TRUE(robot.state().stalled);
  ASSERT_TRUE(robot.state().contact || robot.state().stalled);
  EXPECT_LT(robot.state().odom_from_robot.x, 1.80) << "held wheels do not count";
  drive(robot, 0.0, 1.0, 4.0);
  EXPECT_FALSE(robot.state().stalled);
  drive(robot, -0.3, 0.0, 0.1);
  const double x_before = robot.state().map_from_robot.x;
  drive(robot, robot.state().map_from_robot.theta > 1.6 || robot.state().map_from_robot.theta < -1.6 ? 0.3 : -0.3, 0.0,
        3.0);
  EXPECT_LT(robot.state().map_from_robot.x, x_before - 0.2);
}

TEST(Robot, DoesNotPushThroughPeople) {
  Robot robot{perfect_body(), {5, 10, 0}, Random{1}};
  const std::vector<Circle> people{{{7, 10}, 0.2}};
  drive(robot, 0.5, 0.0, 10.0, people);
  EXPECT_LT(robot.state().map_from_robot.x, 7.0 - 0.45 + 1e-6);
  EXPECT_TRUE(robot.state().stalled);
}

}  // namespace
}  // namespace deltamap::simulation
