// SPDX-License-Identifier: Apache-2.0
// Keeps the times of one device's messages in order. ReceivedBytes tells the latest time at which a message can have
// begun. Where bytes come faster than the line carries them (an adapter or the kernel hands over what waited in several
// reads, one right after the other), that may be before a message that has been told already; it then follows that one
// at once, which is the nearest to the truth that keeps the order. Needs nothing but the chunks: a replay answers the
// same times.
#pragma once

#include "core/time.hpp"

namespace deltamap::drivers {

/// Between two messages at least: two times so far apart differ as seconds of Unix time in a double, too.
inline constexpr Duration kLeastBetweenMessages{1'000};

class MonotonicTimes {
 public:
  /// The time of the next message: `estimated`, or just after the message before. `received` is the stamp of the chunk
  /// that completed it. Where the stamps themselves go back, the recorded clock was set back, and the order begins
  /// anew.
  [[nodiscard]] Timestamp next(Timestamp estimated, Timestamp received);

 private:
  Timestamp last_ = Timestamp::min();
  Timestamp last_received_ = Timestamp::min();
};

}  // namespace deltamap::drivers
