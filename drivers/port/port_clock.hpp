// SPDX-License-Identifier: Apache-2.0
// The clock that stamps bytes: it runs steadily as the monotonic clock does, and its offset to Unix time is taken once,
// at the first call, so that a correction of the system's time never makes a jump between two chunks.
#pragma once

#include "core/time.hpp"

namespace deltamap::drivers::port {

[[nodiscard]] Timestamp port_clock_now();

}  // namespace deltamap::drivers::port
