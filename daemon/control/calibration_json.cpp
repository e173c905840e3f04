// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/calibration_json.hpp"

#include <nlohmann/json.hpp>

#include "core/geometry/angle.hpp"

namespace deltamap::daemon::control {
namespace {

using Json = nlohmann::ordered_json;

Json numbers_json(const localization::motion::WheelErrors& wheels, const Pose2& mount) {
  return {{"distance_percent", 100.0 * wheels.distance},
          {"turn_percent", 100.0 * wheels.turn},
          {"drift_deg_per_m", degrees(wheels.drift_rad_per_m)},
          {"lag_ms", 1e3 * wheels.lag_s},
          {"mount", {{"x_mm", 1e3 * mount.x}, {"y_mm", 1e3 * mount.y}, {"yaw_deg", degrees(mount.theta)}}}};
}

}  // namespace

std::string calibration_json(const std::optional<localization::motion::DriveCalibration>& calibration) {
  if (!calibration) return "null";
  Json json = numbers_json(calibration->wheels, calibration->mount_error);
  json["deviations"] = numbers_json(calibration->wheel_deviations, calibration->mount_deviations);
  return json.dump();
}

}  // namespace deltamap::daemon::control
