// SPDX-License-Identifier: Apache-2.0
#include "drivers/monotonic_times.hpp"

#include <algorithm>

namespace deltamap::drivers {

Timestamp MonotonicTimes::next(Timestamp estimated, Timestamp received) {
  const bool clock_was_set_back = received < last_received_;
  last_ = clock_was_set_back ? estimated : std::max(estimated, last_ + kLeastBetweenMessages);
  last_received_ = received;
  return last_;
}

}  // namespace deltamap::drivers
