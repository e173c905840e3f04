// SPDX-License-Identifier: Apache-2.0
// For how long what was written is provisional.
#include "mapping/gate/provisional_window.hpp"

#include <gtest/gtest.h>

#include "tests/mapping/straight_drive.hpp"

namespace deltamap::mapping::gate {
namespace {

void drive(StraightDrive& robot, ProvisionalWindow& window, double duration_s, bool counts = true) {
  for (double t = 0.0; t < duration_s - 1e-9; t += kPeriod_s) {
    window.observe(robot.next().scan.time, counts ? kPeriod_s : 0.0, counts ? robot.speed_m_per_s * kPeriod_s : 0.0);
  }
}

TEST(ProvisionalWindow, NeedsBothWayAndTime) {
  StraightDrive robot;
  ProvisionalWindow window{{.way_m = 10.0, .time_s = 30.0}};
  drive(robot, window, 19.0);  // 9.5 m
  EXPECT_FALSE(window.settled());
  drive(robot, window, 41.0);  // 30 m: time is what takes longer
  ASSERT_TRUE(window.settled());
  EXPECT_NEAR(seconds(robot.now() - *window.settled()), 30.0, 0.3);
}

TEST(ProvisionalWindow, TimeAloneSettlesNothing) {
  StraightDrive robot;
  ProvisionalWindow window{{.way_m = 10.0, .time_s = 30.0}};
  drive(robot, window, 60.0);
  const Timestamp stopped = robot.now();
  robot.speed_m_per_s = 0.0;
  drive(robot, window, 3600.0);
  ASSERT_TRUE(window.settled());
  EXPECT_NEAR(seconds(stopped - *window.settled()), 20.0, 0.5) << "what was written 10 m before it stopped";
}

TEST(ProvisionalWindow, WhatPassesInDoubtDoesNotCount) {
  StraightDrive robot;
  ProvisionalWindow window{{.way_m = 10.0, .time_s = 30.0}};
  drive(robot, window, 60.0);
  const Timestamp settled = *window.settled();
  drive(robot, window, 60.0, false);
  EXPECT_EQ(window.settled(), settled);
}

}  // namespace
}  // namespace deltamap::mapping::gate
