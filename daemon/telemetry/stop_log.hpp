// SPDX-License-Identifier: Apache-2.0
// One log line where driving, or driving by the pose, ends for a reason that a person should learn of, and one where it
// goes on: asked many times a second, it answers once.
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
    return {"driving stops: " + with_end(reason), true};
  }

  /// The line that is due for planners, whoever drives; a warning where robot or laser, not the pose, forbids it.
  [[nodiscard]] LogLine line_for_planners(navigation::StopReason unfit, navigation::StopReason pose) {
    using navigation::StopReason;
    const StopReason forbidden_by = unfit != StopReason::kNone ? unfit : pose;
    if (forbidden_by == StopReason::kNone && told_planners_ != StopReason::kNone) {
      told_planners_ = StopReason::kNone;
      return {"planners may drive by the pose again"};
    }
    if (!is_told(forbidden_by) || forbidden_by == told_planners_) return {};
    told_planners_ = forbidden_by;
    return {"planners must not drive by the pose: " + with_end(forbidden_by), unfit != StopReason::kNone};
  }

  /// What has been told of driving says all that planners are told.
  [[nodiscard]] bool says_it_all() const { return told_ == told_planners_; }

 private:
  static std::string with_end(navigation::StopReason reason) {
    const char* until =
        waits_for_person(reason) ? "; waits until it is over and a person says drive" : "; until it is over";
    return std::string(name_of(reason)) + until;
  }

  navigation::StopReason told_ = navigation::StopReason::kNone;
  navigation::StopReason told_planners_ = navigation::StopReason::kNone;
};

}  // namespace deltamap::daemon
