// SPDX-License-Identifier: Apache-2.0
// One log line where driving ends for a reason that a person should learn of, and one where it goes on: asked many
// times a second, it answers once.
#pragma once

#include <string>

#include "daemon/telemetry/log_line.hpp"
#include "navigation/stop_reason.hpp"

namespace deltamap::daemon {

class StopLog {
 public:
  /// The line that is due now that this is the reason; a warning where driving ends.
  [[nodiscard]] LogLine line(navigation::StopReason reason) {
    using navigation::StopReason;
    const bool drives = reason == StopReason::kNone || reason == StopReason::kObstacle;
    if (drives && told_ != StopReason::kNone) {
      told_ = StopReason::kNone;
      return {"driving goes on"};
    }
    if (!is_told(reason) || reason == told_) return {};
    told_ = reason;
    const char* until =
        waits_for_person(reason) ? "; waits until it is over and a person says drive" : "; until it is over";
    return {"driving stops: " + std::string(name_of(reason)) + until, true};
  }

 private:
  navigation::StopReason told_ = navigation::StopReason::kNone;
};

}  // namespace deltamap::daemon
