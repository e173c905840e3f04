// SPDX-License-Identifier: Apache-2.0
#include "localization/odometer/scan_witness.hpp"

namespace deltamap::localization::odometer {

LaserMotion ScanWitness::observe(const Scan& scan, std::span<const RayInRobot> rays, motion::OdometryBuffer& wheels,
                                 const motion::OdometryBuffer& reports, bool leads) {
  if (const std::optional<double> lag_s = lag_.lag_s()) wheels.set_lag(*lag_s);
  std::optional<WheelsAt> told;
  if (const auto at = wheels.at(scan.time)) told = {at->continuous_odom_from_robot, at->epoch};
  LaserMotion seen = odometer_.observe(scan, rays, told, leads);
  if (seen.slip) {
    wheels.correct(scan.time, *seen.slip, {0.5 * seen.covariance.topLeftCorner<2, 2>().trace(), seen.covariance(2, 2)});
  }
  if (leads && last_ && seen.slip) wheels.led_by_scans(*last_, scan.time);
  if (last_ && !seen.is_lost && !leads) lag_.observe(*last_, scan.time, seen.by_laser.theta, reports);
  last_ = scan.time;
  return seen;
}

}  // namespace deltamap::localization::odometer
