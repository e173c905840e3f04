// SPDX-License-Identifier: Apache-2.0
// What a person who looks at a run wants to jump to: changes and refusals of the map, losses of the pose, gaps between
// scans, an operator's orders, and what the incident tells that the recording belongs to.
#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "daemon/incidents/incident.hpp"
#include "daemon/incidents/incident_watch.hpp"
#include "daemon/outputs/change_note.hpp"
#include "daemon/outputs/localization_log.hpp"
#include "daemon/records/journal.hpp"

namespace deltamap::tool {

/// Any thread.
class RunEvents {
 public:
  static constexpr double kGapS = 2.0;                ///< between two scans
  static constexpr std::size_t kMostEvents = 20'000;  ///< those that come later are left out

  void observe(const daemon::LocalizationRow& row);
  void observe(const daemon::ChangeNote& note);
  /// Those without a time, of old recordings, are left out.
  void add_orders(const std::vector<daemon::Decision>& commands);
  void add(const daemon::Incident& incident);

  /// A JSON array in the order of time: {"time":…,"kind":…,"words":…}, kind change, refusal, loss, gap, order or
  /// incident.
  [[nodiscard]] std::string json() const;

 private:
  struct Event {
    Timestamp time;
    const char* kind;
    std::string words;
  };
  void add(Event event);

  mutable std::mutex mutex_;
  std::vector<Event> events_;
  daemon::PoseWatch pose_watch_;
  std::optional<Timestamp> newest_;
};

}  // namespace deltamap::tool
