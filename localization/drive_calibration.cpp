// SPDX-License-Identifier: Apache-2.0
#include "localization/drive_calibration.hpp"

namespace deltamap::localization {

Pose2 corrected(const WheelStep& step, const WheelErrors& errors) {
  const double further_rad = errors.turn * step.motion.theta + errors.drift_rad_per_m * step.motion.position().norm() +
                             errors.lag_s * step.turn_rate_change_rad_per_s;
  const Pose2 along_the_arc = Pose2{0.0, 0.0, 0.5 * further_rad} * step.motion;
  return {(1.0 + errors.distance) * along_the_arc.x + errors.lag_s * step.speed_change_m_per_s,
          (1.0 + errors.distance) * along_the_arc.y, step.motion.theta + further_rad};
}

}  // namespace deltamap::localization
