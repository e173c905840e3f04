// SPDX-License-Identifier: Apache-2.0
// Says in the log that wheels and scans contradict each other scan after scan: a robot whose pose does not come, or
// comes in other axes or units than believed. One that slips, spins or is carried contradicts its scans for seconds.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "core/messages.hpp"
#include "daemon/telemetry/log_line.hpp"

namespace deltamap::daemon {

class WheelWatch {
 public:
  void observe(const Odometry& odometry);
  /// After each scan. `contradicted`: scans so far that tell of another motion than the wheels
  /// (LocalizerCounts::wheels_contradicted). A line of no text where there is nothing to say.
  [[nodiscard]] LogLine observe(const TrackedScan& tracked, std::uint64_t contradicted);
  /// In one of the last scans in ten, or more.
  [[nodiscard]] bool contradicted_of_late() const;
  /// They contradict each other now.
  [[nodiscard]] bool contradict() const { return contradict_; }

 private:
  /// What was seen in one second.
  struct Second {
    Timestamp began;
    std::uint32_t scans = 0;
    std::uint32_t contradicted = 0;
  };
  void count(Timestamp time, bool contradicts);
  [[nodiscard]] LogLine judged();

  std::optional<Pose2> first_pose_;
  bool has_moved_ = false;
  std::deque<Second> seconds_;  // of the last minutes
  std::uint64_t before_ = 0;
  bool contradict_ = false;
};

}  // namespace deltamap::daemon
