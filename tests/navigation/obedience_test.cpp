// SPDX-License-Identifier: Apache-2.0
#include "navigation/obedience.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.hpp"

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

TEST(Obedience, IsShownByARobotThatActsAsLateAsItMayOnWhatItWasToldLongBefore) {
  constexpr double kLateS = 0.4;
  for (const double brakes_m_per_s2 : {0.3, 2.0}) {
    Obedience obedience;
    Odometry odometry;
    odometry.motors_enabled = true;
    odometry.speed_m_per_s = 0.7;
    obedience.told({0.7, 0.0}, kBegin);
    for (int step = 1; step <= 60; ++step) {
      odometry.time = kBegin + duration_from_seconds(kToldEveryS * step);
      const double told_to_stand_s = kToldEveryS * (step - 20);  // by the first word for two seconds
      if (told_to_stand_s >= 0.0) obedience.told({0.0, 0.0}, odometry.time);
      const double brakes_s = std::max(0.0, told_to_stand_s - kLateS);
      odometry.speed_m_per_s = std::max(0.0, 0.7 - brakes_m_per_s2 * brakes_s);
      obedience.observe(odometry, {.watchdog_s = 2.0, .deceleration_m_per_s2 = brakes_m_per_s2});
      ASSERT_FALSE(obedience.disobeys()) << brakes_m_per_s2 << " m/s², " << told_to_stand_s << " s after the order";
    }
  }
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

constexpr double kMostGoneM = 0.2;  // where it was told to stand or to go the other way
constexpr double kMostTurnedRad = radians(40.0);

/// How far a robot gets that does what it likes, until that is noticed; at most as far as it gets in a minute.
Motion gone_unnoticed(const Motion& told, const Motion& does) {
  Robot robot;
  robot.pass(3.0, told);
  EXPECT_FALSE(robot.disobeyed);
  robot.obeys = false;
  robot.odometry.speed_m_per_s = does.speed_m_per_s;
  robot.odometry.turn_rate_rad_per_s = does.turn_rate_rad_per_s;
  const Timestamp begin = robot.now;
  while (!robot.disobeyed && seconds(robot.now - begin) < 60.0) robot.pass(kToldEveryS, told);
  const double for_s = seconds(robot.now - begin);
  return {for_s * does.speed_m_per_s, for_s * does.turn_rate_rad_per_s};
}

TEST(Obedience, IsNotShownByARobotThatCreepsAlongAgainstItsOrders) {
  for (const double told : {0.0, 0.05, 0.5}) {
    for (const double does : {-0.02, -0.05, -0.09}) {
      EXPECT_LT(-gone_unnoticed({told, 0.0}, {does, 0.0}).speed_m_per_s, kMostGoneM) << told << " " << does;
    }
  }
  for (const double does : {0.02, 0.05, 0.09}) {
    EXPECT_LT(gone_unnoticed({0.0, 0.0}, {does, 0.0}).speed_m_per_s, kMostGoneM) << does;
  }
}

TEST(Obedience, IsNotShownByARobotThatTurnsSlowlyAgainstItsOrders) {
  for (const Motion& told : {Motion{0.0, 0.0}, Motion{0.3, 0.0}, Motion{0.3, radians(30.0)}}) {
    for (const double does : {radians(-5.0), radians(-15.0)}) {
      EXPECT_LT(-gone_unnoticed(told, {told.speed_m_per_s, does}).turn_rate_rad_per_s, kMostTurnedRad)
          << told.turn_rate_rad_per_s << " " << does;
    }
  }
}

TEST(Obedience, IsShownByWheelsThatAreMeasuredAndRegulatedWithNoise) {
  for (const Motion& told : {Motion{0.0, 0.0}, Motion{0.03, 0.0}, Motion{0.4, radians(20.0)}}) {
    Robot robot;
    Random random{7};
    robot.pass(3.0, told);
    robot.obeys = false;
    for (int i = 0; i < 6000; ++i) {
      const double share = told.speed_m_per_s > 0.0 ? 1.0 : 0.2;  // of the noise: a wheel that stands has little
      robot.odometry.speed_m_per_s = 1.05 * told.speed_m_per_s + share * random.normal(0.02);
      robot.odometry.turn_rate_rad_per_s = 1.05 * told.turn_rate_rad_per_s + share * random.normal(radians(4.0));
      robot.pass(kToldEveryS, told);
    }
    EXPECT_FALSE(robot.disobeyed) << told.speed_m_per_s;
  }
}

TEST(Obedience, IsShownByARobotThatIsNudgedWhileItStands) {
  Robot robot;
  robot.pass(1.0, {0.0, 0.0});
  robot.obeys = false;
  for (int i = 0; i < 10; ++i) {
    robot.odometry.speed_m_per_s = 0.1;
    robot.pass(0.5, {0.0, 0.0});
    robot.odometry.speed_m_per_s = 0.0;
    robot.pass(10.0, {0.0, 0.0});
  }
  EXPECT_FALSE(robot.disobeyed);
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
