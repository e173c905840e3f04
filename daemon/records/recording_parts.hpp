// SPDX-License-Identifier: Apache-2.0
// The parts of a recording that is a ring: beside NAME.pcapng, which grows, lie NAME.20261130T030000Z.pcapng and so on,
// named after the moment at which they began. Each replays by itself.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/time.hpp"

namespace deltamap::daemon {

/// What a ring keeps. 0: no such rule.
struct RingLimits {
  double keep_gigabytes = 0.0;
  double keep_hours = 0.0;
};

/// The part that grows has its size or its length: a tenth of what is kept, at most 256 MB and an hour.
[[nodiscard]] bool is_part_full(const RingLimits& limits, std::uint64_t bytes, double lasted_s);

/// Where a part of this recording is kept that began then; one that is there already is not overwritten.
[[nodiscard]] std::filesystem::path place_of_part(const std::filesystem::path& recording, Timestamp began);

/// The parts beside the recording, oldest first.
[[nodiscard]] std::vector<std::filesystem::path> parts_of(const std::filesystem::path& recording);

/// Where the recording of an earlier run goes: it is a part of the ring, which begins with its first record.
[[nodiscard]] std::filesystem::path place_of_earlier(const std::filesystem::path& recording);

/// Removes the oldest parts until the others and the recording are within the limits; a part is as old as its end. What
/// cannot be removed is tried again at the next part.
void drop_oldest_parts(const std::filesystem::path& recording, const RingLimits& limits);

}  // namespace deltamap::daemon
