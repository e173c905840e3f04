// SPDX-License-Identifier: Apache-2.0
// Why: a wheel that is worn or a laser that is mounted askew errs in the same direction at every step. As noise it
// would have to be as wide as the error itself; estimated, it is taken out and the noise stays small.
#include "localization/motion/drive_calibration.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::localization::motion {

Pose2 corrected(const WheelStep& step, const WheelErrors& errors) {
  const double further_rad = errors.turn * step.motion.theta + errors.drift_rad_per_m * step.motion.position().norm() +
                             errors.lag_s * step.turn_rate_change_rad_per_s;
  const Pose2 along_the_arc = Pose2{0.0, 0.0, 0.5 * further_rad} * step.motion;
  return {(1.0 + errors.distance) * along_the_arc.x + errors.lag_s * step.speed_change_m_per_s,
          (1.0 + errors.distance) * along_the_arc.y, step.motion.theta + further_rad};
}

std::array<double, 14> numbers_of(const DriveCalibration& calibration) {
  const auto& [wheels, wheel_deviations, mount, mount_deviations] = calibration;
  return {wheels.distance,
          wheels.turn,
          wheels.drift_rad_per_m,
          wheels.lag_s,
          wheel_deviations.distance,
          wheel_deviations.turn,
          wheel_deviations.drift_rad_per_m,
          wheel_deviations.lag_s,
          mount.x,
          mount.y,
          mount.theta,
          mount_deviations.x,
          mount_deviations.y,
          mount_deviations.theta};
}

std::optional<DriveCalibration> calibration_of(std::span<const double> n) {
  if (n.size() != 14 || !std::all_of(n.begin(), n.end(), [](double number) { return std::isfinite(number); }))
    return std::nullopt;
  const DriveCalibration read{
      {n[0], n[1], n[2], n[3]}, {n[4], n[5], n[6], n[7]}, {n[8], n[9], n[10]}, {n[11], n[12], n[13]}};
  const auto is_negative = [](double deviation) { return deviation < 0.0; };
  const bool is_wrong =
      std::any_of(n.begin() + 4, n.begin() + 8, is_negative) || std::any_of(n.begin() + 11, n.end(), is_negative);
  return is_wrong ? std::nullopt : std::optional{read};
}

}  // namespace deltamap::localization::motion
