// SPDX-License-Identifier: Apache-2.0
// Instants and durations. A Timestamp counts nanoseconds of Unix time in 64 bits; formulas use seconds as double.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>

namespace deltamap {

using Duration = std::chrono::nanoseconds;
using Timestamp = std::chrono::sys_time<Duration>;

[[nodiscard]] constexpr double seconds(Duration duration) { return static_cast<double>(duration.count()) * 1e-9; }

/// Rounded to the nearest nanosecond.
[[nodiscard]] inline Duration duration_from_seconds(double seconds) {
  return Duration{static_cast<std::int64_t>(std::llround(seconds * 1e9))};
}

[[nodiscard]] constexpr Timestamp timestamp_from_ns(std::int64_t unix_ns) { return Timestamp{Duration{unix_ns}}; }
[[nodiscard]] constexpr std::int64_t unix_ns(Timestamp time) { return time.time_since_epoch().count(); }

/// For people and other programs: at today's times good to a quarter of a microsecond.
[[nodiscard]] constexpr double unix_seconds(Timestamp time) { return seconds(time.time_since_epoch()); }

}  // namespace deltamap
