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
    const bool drives =
        reason == StopReason::kNone || reason == StopReason::kObstacle || reason == StopReason::kBlockedZone;
    return due(told_, reason, drives, {.ends = "driving stops: ", .goes_on = "driving goes on", .is_warning = true});
  }

  /// The line that is due for planners, whoever drives; a warning where robot or laser, not the pose, forbids it.
  [[nodiscard]] LogLine line_for_planners(navigation::StopReason unfit, navigation::StopReason pose) {
    using navigation::StopReason;
    const StopReason forbidden_by = unfit != StopReason::kNone ? unfit : pose;
    return due(told_planners_, forbidden_by, forbidden_by == StopReason::kNone,
               {.ends = "planners must not drive by the pose: ",
                .goes_on = "planners may drive by the pose again",
                .is_warning = unfit != StopReason::kNone});
  }

  /// What has been told of driving says all that planners are told.
  [[nodiscard]] bool says_it_all() const { return told_ == told_planners_; }

 private:
  struct Words {
    const char* ends;
    const char* goes_on;
    bool is_warning;  // that it ends
  };
  static LogLine due(navigation::StopReason& told, navigation::StopReason reason, bool goes_on, const Words& words) {
    using navigation::StopReason;
    if (goes_on && told != StopReason::kNone) {
      told = StopReason::kNone;
      return {words.goes_on};
    }
    if (!is_told(reason) || reason == told) return {};
    told = reason;
    const char* until =
        waits_for_person(reason) ? "; waits until it is over and a person says drive" : "; until it is over";
    return {words.ends + std::string(name_of(reason)) + until, words.is_warning};
  }

  navigation::StopReason told_ = navigation::StopReason::kNone;
  navigation::StopReason told_planners_ = navigation::StopReason::kNone;
};

}  // namespace deltamap::daemon
