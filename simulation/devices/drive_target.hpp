// SPDX-License-Identifier: Apache-2.0
// What the controller asks of the motors: from the commands that it was sent (devices/set_points) to the body (robot).
#pragma once

namespace deltamap::simulation::devices {

/// Rates of change as the robot is delivered (protocols.md A10: TRANSACC 300 mm/s², ROTACC 100 deg/s²); all > 0.
struct DriveTarget {
  double speed_m_per_s = 0.0;        ///< forward
  double turn_rate_rad_per_s = 0.0;  ///< counter-clockwise
  double acceleration_m_per_s2 = 0.3;
  double deceleration_m_per_s2 = 0.3;
  double turn_acceleration_rad_per_s2 = 1.75;
  double turn_deceleration_rad_per_s2 = 1.75;
};

}  // namespace deltamap::simulation::devices
