// SPDX-License-Identifier: Apache-2.0
// What is worth keeping as an incident: of the poses the losses, in a live run and in its replay alike; of robot, laser
// and map what telemetry shows.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/incidents/incident.hpp"
#include "daemon/outputs/localization_log.hpp"
#include "daemon/telemetry/telemetry.hpp"
#include "navigation/stop_reason.hpp"

namespace deltamap::daemon {

class PoseWatch {
 public:
  /// Each localized scan, in order.
  [[nodiscard]] std::optional<IncidentEvent> observe(const LocalizationRow& row);

 private:
  std::optional<LocalizerState> state_;
  Timestamp time_;
};

class RunWatch {
 public:
  /// So many refused updates of the map, one after another, are an event.
  static constexpr std::uint32_t kRefusals = 3;

  /// Many times a second.
  [[nodiscard]] std::vector<IncidentEvent> observe(const Telemetry& telemetry, Timestamp now);

 private:
  void watch_devices(const Telemetry& telemetry, Timestamp now, std::vector<IncidentEvent>& events);
  void watch_stops(const Telemetry& telemetry, Timestamp now, std::vector<IncidentEvent>& events);
  void watch_map(const Telemetry& telemetry, Timestamp now, std::vector<IncidentEvent>& events);

  std::optional<Timestamp> robot_up_;  // at the newest look at which it was; nothing: not yet, or its silence is told
  std::optional<Timestamp> laser_up_;
  navigation::StopReason stop_ = navigation::StopReason::kNone;   // of those that are events
  navigation::StopReason unfit_ = navigation::StopReason::kNone;  // of those that are events
  std::optional<std::uint32_t> revision_;
  std::uint32_t refused_before_ = 0;  // when the streak began
  bool streak_is_told_ = false;
};

/// What such a stop is; nothing for those that driving brings with it, and for a pose that is lost or searched for.
[[nodiscard]] std::optional<IncidentKind> kind_of(navigation::StopReason reason);

}  // namespace deltamap::daemon
