// SPDX-License-Identifier: Apache-2.0
// The time that has passed in a recording: a clock that was set back does not begin it anew.
#pragma once

#include <algorithm>
#include <optional>

#include "core/time.hpp"

namespace deltamap::drivers::port {

class PassedTime {
 public:
  /// Less than that is two ports out of order.
  static constexpr double kSetBackS = 1.0;

  /// Takes the stamp of the next record and answers the seconds since the first one, on the clock as it is set now; not
  /// negative.
  [[nodiscard]] double after_s(Timestamp stamp) {
    if (!began_) began_ = last_ = stamp;
    set_back_s_ = seconds(last_ - stamp) > kSetBackS ? seconds(last_ - stamp) : 0.0;
    if (set_back_s_ > 0.0) began_ = *began_ - (last_ - stamp);
    last_ = stamp;
    return std::max(0.0, seconds(stamp - *began_));
  }
  /// By how much the clock was set back before the newest record; 0: it was not.
  [[nodiscard]] double set_back_s() const { return set_back_s_; }

 private:
  std::optional<Timestamp> began_;  // on the clock as it is set now
  Timestamp last_{};
  double set_back_s_ = 0.0;
};

}  // namespace deltamap::drivers::port
