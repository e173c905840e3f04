// SPDX-License-Identifier: Apache-2.0
// A localized scan as one line of JSON, for the live page and for other programs (docs/api.md).
#pragma once

#include <optional>
#include <string>

#include "daemon/outputs/localization_log.hpp"
#include "mapping/gate/write_gate.hpp"
#include "navigation/stop_reason.hpp"

namespace deltamap::daemon {

/// What the pilot wants the robot to do.
struct PilotWish {
  double speed_m_per_s = 0.0;
  double turn_rate_rad_per_s = 0.0;
};

/// What is told of a localized scan.
struct PoseNews {
  LocalizationRow row;
  double latency_s = 0.0;                         ///< from the scan's last byte to its pose
  std::optional<mapping::gate::GateReason> gate;  ///< nothing: nobody works on the map
  std::optional<PilotWish> pilot{};               ///< nothing: it does not drive, or is not told of
  /// What forbids to drive by this pose (telemetry); nothing: not told of.
  std::optional<navigation::StopReason> forbidden_by{};
};

/// "pose": the pose, what is believed of it, and the write gate. Without line end.
[[nodiscard]] std::string pose_line(const PoseNews& news);

}  // namespace deltamap::daemon
