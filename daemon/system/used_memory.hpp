// SPDX-License-Identifier: Apache-2.0
// How much memory this process has taken; 0 where the system does not tell.
#pragma once

#include <cstdint>

namespace deltamap::daemon {

/// Now.
[[nodiscard]] std::uint64_t resident_bytes();
/// Most so far.
[[nodiscard]] std::uint64_t peak_resident_bytes();

}  // namespace deltamap::daemon
