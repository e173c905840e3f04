// SPDX-License-Identifier: Apache-2.0
// At which speeds a robot is looked for, and for how long (protocols.md A4): most often where it waits for a
// connection and where a connection may have been left, and at every other speed now and then.
#pragma once

#include <vector>

#include "core/time.hpp"

namespace deltamap::drivers::pioneer {

struct BaudProbe {
  unsigned baud = 9600;
  Duration echo_timeout{};  ///< how long SYNC0 may remain without an answer
};

/// One search. `idle`: where the robot waits; `left`: where a connection may have been left; `wanted`: where
/// connections of ours are switched to, which a robot may have obeyed although it did not seem so.
[[nodiscard]] std::vector<BaudProbe> baud_search(unsigned idle, unsigned left, unsigned wanted);

}  // namespace deltamap::drivers::pioneer
