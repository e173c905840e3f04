// SPDX-License-Identifier: Apache-2.0
// A stop that outlives its cause: it holds until the cause is gone and a person has then said drive.
#pragma once

#include "navigation/stop_reason.hpp"

namespace deltamap::navigation {

class StopLatch {
 public:
  constexpr explicit StopLatch(StopReason reason) : reason_{reason} {}

  void observe(bool is_present) {
    is_present_ = is_present;
    is_held_ = is_held_ || is_present;
  }
  /// A person said drive: of no effect while the cause is still there.
  void release() { is_held_ = is_present_; }

  [[nodiscard]] bool is_held() const { return is_held_; }
  [[nodiscard]] StopReason reason() const { return reason_; }

 private:
  StopReason reason_;
  bool is_present_ = false;
  bool is_held_ = false;
};

}  // namespace deltamap::navigation
