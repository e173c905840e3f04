// SPDX-License-Identifier: Apache-2.0
// Says in the log, once, that the scans of a drive show another mount of the laser than the settings name, and how to
// name it.
#pragma once

#include "core/messages.hpp"
#include "daemon/telemetry/log_line.hpp"
#include "localization/motion/odometry_buffer.hpp"
#include "navigation/mount_check.hpp"

namespace deltamap::daemon {

class MountWatch {
 public:
  /// `is_upside_down`: as 'laser.mount.upside_down' says.
  MountWatch(const localization::motion::OdometryBufferParams& odometry, bool is_upside_down)
      : wheels_{odometry}, is_upside_down_{is_upside_down} {}

  void observe(const Odometry& odometry) { wheels_.add(odometry); }
  /// With the mount of the settings. A line of no text where there is nothing to say. `contradicted`: scans of late
  /// show another motion than the wheels tell, as those of a laser that is mounted otherwise do; else nothing is asked.
  [[nodiscard]] LogLine observe(const Scan& scan, bool contradicted);
  /// It has said so.
  [[nodiscard]] bool is_told() const { return is_told_; }

 private:
  /// As they report: what the localizer makes of them follows a laser that is mounted wrong.
  localization::motion::OdometryBuffer wheels_;
  navigation::MountCheck check_;
  bool is_upside_down_;
  bool is_told_ = false;
};

}  // namespace deltamap::daemon
