// SPDX-License-Identifier: Apache-2.0
// What is known in the midst of a run, now and then: enough for a recording to begin there.
#pragma once

#include <memory>
#include <optional>

#include "core/grid/occupancy_grid.hpp"
#include "daemon/kept/kept_pose.hpp"
#include "daemon/outputs/localization_log.hpp"
#include "localization/belief/stability_record.hpp"

namespace deltamap::daemon {

/// Seconds between two of them.
inline constexpr double kCheckpointPeriodS = 10.0;

struct Checkpoint {
  LocalizationRow row;  ///< of the newest scan
  KeptPose pose;        ///< of that scan; with calibration
  std::shared_ptr<const OccupancyGrid> map;
  std::optional<localization::belief::StabilityRecord> stability{};
};

}  // namespace deltamap::daemon
