// SPDX-License-Identifier: Apache-2.0
// What a Pioneer's controller was last told about motion (protocols.md A5: VEL, RVEL, VEL2, MOVE, HEAD, DHEAD, STOP,
// ESTOP, SETA, SETV, SETRA, SETRV) and what follows for the motors at a moment.
#pragma once

#include <optional>

#include "core/geometry/pose2.hpp"
#include "drivers/pioneer/command.hpp"
#include "simulation/devices/drive_target.hpp"
#include "simulation/devices/robot_kind.hpp"

namespace deltamap::simulation::devices {

/// What the wheels' encoders and the body's sensors tell the controller.
struct WheelMotion {
  Pose2 odom_from_robot;
  double speed_m_per_s = 0.0;
  double turn_rate_rad_per_s = 0.0;
  double travelled_m = 0.0;  ///< forward, signed, since power-on
  double turned_rad = 0.0;   ///< counter-clockwise, not wrapped, since power-on
  bool stalled = false;
  std::optional<double> contact_bearing_rad;  ///< where the body touches something, robot frame
};

/// Values as the robot is delivered (A10: TRANSVELMAX 750 mm/s, ROTVELMAX 100 deg/s, TRANSACC 300, ROTACC 100).
class SetPoints {
 public:
  /// A command that says how to move; all but those that stop at once.
  [[nodiscard]] static bool is_set_point(drivers::pioneer::CommandNumber number);
  /// Takes a command of motion; false for any other.
  bool take(const drivers::pioneer::Command& command, const WheelMotion& motion);

  [[nodiscard]] DriveTarget demand(const WheelMotion& motion) const;
  /// Standing still as fast as the set decelerations allow.
  [[nodiscard]] DriveTarget standstill() const;

  // The limits in force (A5: SETV, SETRV, SETA, SETRA).
  [[nodiscard]] double max_speed_m_per_s() const { return max_speed_m_per_s_; }
  [[nodiscard]] double max_turn_rate_rad_per_s() const { return max_turn_rate_rad_per_s_; }
  [[nodiscard]] const DriveTarget& rates() const { return limits_; }

  /// Since ESTOP.
  [[nodiscard]] bool is_emergency() const { return emergency_; }

  /// The heading that is being held, if one is.
  [[nodiscard]] std::optional<double> heading_rad() const { return heading_rad_; }

 private:
  void set_speed(double speed_m_per_s);
  void set_turn_rate(double turn_rate_rad_per_s);
  /// VEL, ROTATE, RVEL, VEL2.
  void take_velocity(const drivers::pioneer::Command& command);
  /// MOVE, HEAD, DHEAD.
  void take_goal(const drivers::pioneer::Command& command, const WheelMotion& motion);
  void stop(bool at_once);
  void take_limit(const drivers::pioneer::Command& command);
  [[nodiscard]] double wanted_speed(const WheelMotion& motion) const;
  [[nodiscard]] double wanted_turn_rate(const WheelMotion& motion) const;

  double speed_m_per_s_ = 0.0;
  double turn_rate_rad_per_s_ = 0.0;
  std::optional<double> heading_rad_;  // HEAD, DHEAD: odometry frame
  std::optional<double> move_to_m_;    // MOVE: value of travelled_m to stop at
  bool emergency_ = false;             // since ESTOP
  double max_speed_m_per_s_ = 0.75;
  double max_turn_rate_rad_per_s_ = 1.745;
  DriveTarget limits_;
};

}  // namespace deltamap::simulation::devices
