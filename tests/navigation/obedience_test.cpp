// SPDX-License-Identifier: Apache-2.0
#include "navigation/obedience.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace deltamap::navigation {
namespace {

constexpr Timestamp kBegin = timestamp_from_ns(1'000'000'000'000);
constexpr double kToldEveryS = 0.1;

/// A robot that is told something ten times a second, and does it with its own delay and acceleration.
struct Robot {
  void pass(double for_s, const Motion& told) {
    for (double t = 0.0; t < for_s - 1e-9; t += kToldEveryS) {
      now += duration_from_seconds(kToldEveryS);
      obedience.told(told, now);
      odometry.time = now;
      obedience.observe(odometry, {.watchdog_s = 2.0, .deceleration_m_per_s2 = 0.3});
      disobeyed = disobeyed || obedience.disobeys();
      if (obeys) odometry.speed_m_per_s += std::clamp(told.speed_m_per_s - odometry.speed_m_per_s, -0.03, 0.03);
      if (obeys) odometry.turn_rate_rad_per_s = told.turn_rate_rad_per_s;
    }
  }
  Robot() { odometry.motors_enabled = true; }

  Obedience obedience;
  Odometry odometry;
  bool obeys = true;
  bool disobeyed = false;
  Timestamp now = kBegin;
};

TEST(Obedience, IsShownByARobotThatGathersAndLosesSpeedAsItIsSetTo) {
  Robot robot;
  for (int round = 0; round < 5; ++round) {
    robot.pass(3.0, {0.7, 0.0});
    robot.pass(0.3, {0.1, 0.8});
    robot.pass(0.2, {0.5, -0.8});
    robot.pass(3.0, {0.0, 0.0});
  }
  EXPECT_FALSE(robot.disobeyed);
}

TEST(Obedience, IsNotShownByARobotThatGoesOnThoughItIsToldToStand) {
  Robot robot;
  robot.pass(3.0, {0.4, 0.0});
  robot.obeys = false;
  robot.pass(1.0, {0.0, 0.0});
  EXPECT_FALSE(robot.disobeyed) << "it may still be braking";
  robot.pass(0.7, {0.0, 0.0});
  EXPECT_TRUE(robot.disobeyed);
}

TEST(Obedience, IsNotShownByARobotThatGoesFasterOrTurnsOtherwise) {
  for (const Motion& does : {Motion{0.8, 0.0}, Motion{-0.3, 0.0}, Motion{0.4, 0.9}, Motion{0.4, -0.9}}) {
    Robot robot;
    robot.pass(3.0, {0.4, 0.0});
    robot.obeys = false;
    robot.odometry.speed_m_per_s = does.speed_m_per_s;
    robot.odometry.turn_rate_rad_per_s = does.turn_rate_rad_per_s;
    robot.pass(1.0, {0.4, 0.0});
    EXPECT_TRUE(robot.disobeyed) << does.speed_m_per_s << " " << does.turn_rate_rad_per_s;
  }
}

TEST(Obedience, GivesARobotThatStandsMoreTimeAndASlowOneAllOfIt) {
  Robot blocked;
  blocked.obeys = false;
  blocked.pass(1.8, {0.4, 0.0});
  EXPECT_FALSE(blocked.disobeyed);
  blocked.pass(3.0, {0.4, 0.0});
  EXPECT_TRUE(blocked.disobeyed);

  Robot slow;
  slow.obeys = false;
  slow.odometry.speed_m_per_s = 0.2;
  slow.pass(10.0, {0.6, 0.0});
  EXPECT_FALSE(slow.disobeyed) << "its controller may be set to less";
}

TEST(Obedience, IsNotAskedOfARobotThatIsPushedWithItsMotorsOffOrThatNobodyTalksTo) {
  Robot robot;
  robot.pass(1.0, {0.0, 0.0});
  robot.obeys = false;
  robot.odometry.motors_enabled = false;
  robot.odometry.speed_m_per_s = 0.8;
  robot.pass(3.0, {0.0, 0.0});
  EXPECT_FALSE(robot.disobeyed);
  robot.odometry.motors_enabled = true;
  robot.obedience.forget();
  for (int i = 0; i < 30; ++i) {
    robot.odometry.time += duration_from_seconds(kToldEveryS);
    robot.obedience.observe(robot.odometry, {.watchdog_s = 2.0});
    EXPECT_FALSE(robot.obedience.disobeys());
  }
}

}  // namespace
}  // namespace deltamap::navigation
