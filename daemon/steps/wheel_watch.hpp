// SPDX-License-Identifier: Apache-2.0
// Says in the log that wheels and scans contradict each other scan after scan: a robot whose pose does not come, or
// comes in other axes or units than believed. One that slips, spins or is carried contradicts its scans for seconds.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
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
  /// They contradict each other now.
  [[nodiscard]] bool contradict() const { return contradict_; }

  static constexpr std::size_t kScans = 600;  ///< the last so many are looked at

 private:
  [[nodiscard]] LogLine judged(std::size_t count);

  std::optional<Pose2> first_pose_;
  bool has_moved_ = false;
  std::bitset<kScans> contradicted_;
  std::size_t next_ = 0;
  std::size_t seen_ = 0;
  std::uint64_t before_ = 0;
  std::optional<Timestamp> began_;
  double watched_s_ = 0.0;
  bool contradict_ = false;
};

}  // namespace deltamap::daemon
