// SPDX-License-Identifier: Apache-2.0
// Which scans are held against what is assumed of things: two a second of those whose pose holds. The delta thread
// hands them to the map thread among the sets, a replay takes them in the same order.
#pragma once

#include <optional>

#include "core/messages.hpp"

namespace deltamap::daemon {

class ThingLooks {
 public:
  /// Every scan that Δ-mapping has looked at, in order.
  [[nodiscard]] bool is_due(const TrackedScan& tracked, bool pose_holds) {
    if (!pose_holds || (last_ && seconds(tracked.scan.time - *last_) < kPeriod_s)) return false;
    last_ = tracked.scan.time;
    return true;
  }

 private:
  static constexpr double kPeriod_s = 0.5;
  std::optional<Timestamp> last_;
};

}  // namespace deltamap::daemon
