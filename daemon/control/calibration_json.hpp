// SPDX-License-Identifier: Apache-2.0
// What driving has told of wheels and mount, as `ctl status` and `calibrate motion` print it.
#pragma once

#include <optional>
#include <string>

#include "localization/motion/drive_calibration.hpp"

namespace deltamap::daemon::control {

/// A JSON object: distance and turn in per cent beyond what the wheels count, drift in degrees a metre, lag in ms, the
/// mount's error in mm and degrees; `deviations` in the same units. Null where nothing is known.
[[nodiscard]] std::string calibration_json(const std::optional<localization::motion::DriveCalibration>& calibration);

}  // namespace deltamap::daemon::control
