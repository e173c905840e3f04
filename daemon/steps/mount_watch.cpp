// SPDX-License-Identifier: Apache-2.0
#include "daemon/steps/mount_watch.hpp"

#include <cmath>
#include <string>

#include "core/geometry/angle.hpp"

namespace deltamap::daemon {
namespace {

double turned_deg(navigation::OtherMount mount) {
  switch (mount) {
    case navigation::OtherMount::kTurnedLeft:
      return 90.0;
    case navigation::OtherMount::kTurnedRound:
      return 180.0;
    case navigation::OtherMount::kTurnedRight:
      return -90.0;
    case navigation::OtherMount::kUpsideDown:
      break;
  }
  return 0.0;
}

/// The setting that would be right.
std::string setting_of(navigation::OtherMount mount, const Scan& scan, bool is_upside_down) {
  if (mount == navigation::OtherMount::kUpsideDown)
    return std::string{"'laser.mount.upside_down: "} + (is_upside_down ? "false'" : "true'");
  const double yaw_rad = wrapped_angle(scan.robot_from_laser.theta + radians(turned_deg(mount)));
  return "'laser.mount.yaw_deg: " + std::to_string(std::lround(degrees(yaw_rad))) + "'";
}

}  // namespace

LogLine MountWatch::observe(const Scan& scan, bool contradicted) {
  if (is_told_) return {};  // by a wrong mount the robot loses its way, and what is shown then is worth less
  const auto wheels = wheels_.at(scan.time);
  if (!wheels) return {};
  check_.observe(scan, wheels->odom_from_robot, wheels->epoch, contradicted);
  const auto shown = check_.shown();
  if (!shown) return {};
  is_told_ = true;
  return {"what the laser sees follows the wheels only if it is mounted otherwise than set: " +
              setting_of(*shown, scan, is_upside_down_) + " fits; look at the laser, then set it",
          true};
}

}  // namespace deltamap::daemon
