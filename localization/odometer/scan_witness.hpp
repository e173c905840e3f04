// SPDX-License-Identifier: Apache-2.0
// Each scan beside what the wheels tell of it: where the scans contradict them the wheels' reports are corrected, and
// their lag is taken out once it is known. Stands between the reports and whoever asks how the robot has moved.
#pragma once

#include <optional>
#include <span>

#include "localization/motion/odometry_buffer.hpp"
#include "localization/odometer/laser_odometer.hpp"
#include "localization/odometer/wheel_lag.hpp"

namespace deltamap::localization::odometer {

class ScanWitness {
 public:
  /// One more scan, `rays` freed of the robot's own motion. Afterwards `wheels` tell what is believed at its time.
  /// `leads`: where the map tells little, the scans' motion takes the wheels' place even where they agree.
  /// `reports`: the same as they came, for the lag; where turns that came late have been corrected none is seen.
  LaserMotion observe(const Scan& scan, std::span<const RayInRobot> rays, motion::OdometryBuffer& wheels,
                      const motion::OdometryBuffer& reports, bool leads = false);

  /// How much too late the wheels' stamps are, s; nothing until it is known.
  [[nodiscard]] std::optional<double> lag_s() const { return lag_.lag_s(); }

 private:
  LaserOdometer odometer_;
  WheelLag lag_;
  std::optional<Timestamp> last_;
};

}  // namespace deltamap::localization::odometer
