// SPDX-License-Identifier: Apache-2.0
// What is wanted of a Pioneer, and how long it is waited for.
#pragma once

#include <string>

#include "drivers/pioneer/drive_permission.hpp"
#include "drivers/pioneer/motion_limits.hpp"
#include "drivers/pioneer/robot_units.hpp"

namespace deltamap::drivers::pioneer {

struct PioneerParams {
  std::string model = "p3dx-sh";  ///< until the robot names itself: "p3dx" or "p3dx-sh"
  RobotByHand by_hand{};          ///< what a robot of an unknown subtype is driven by
  unsigned baud = 9600;           ///< tried first: 9600, 19200, 38400, 57600 or 115200
  unsigned fast_baud = 0;         ///< switched to once connected, where the robot's AUTOBAUD allows; 0: stay
  bool enable_motors = false;     ///< the configuration lets it drive: one half of drive_permission
  DriveSwitch drive_switch = DriveSwitch::kUnknown;  ///< as the run before has left it: the other half
  bool sonar = false;                                ///< keep the sonar on: longer SIPs
  MotionLimits limits{};          ///< set points are clamped to them, and so does the controller once it was told
  double pulse_interval_s = 0.5;  ///< packets to the robot at least this often; well below its watchdog of 2 s
  double sip_timeout_s = 1.0;     ///< silence after which the session has failed
};

}  // namespace deltamap::drivers::pioneer
