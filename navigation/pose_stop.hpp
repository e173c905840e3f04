// SPDX-License-Identifier: Apache-2.0
// Whether the pose that the localizer believes is good enough to drive by.
#pragma once

#include "core/messages.hpp"
#include "navigation/stop_reason.hpp"

namespace deltamap::navigation {

/// kNone where the pose is tracked and not called wrong.
[[nodiscard]] constexpr StopReason pose_stop(const Estimate& estimate) {
  if (estimate.state == LocalizerState::kGlobal) return StopReason::kPoseUnknown;
  if (estimate.state == LocalizerState::kLost) return StopReason::kLost;
  return estimate.belief.verdict == PoseVerdict::kWrong ? StopReason::kPoseWrong : StopReason::kNone;
}

}  // namespace deltamap::navigation
