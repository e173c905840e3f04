// SPDX-License-Identifier: Apache-2.0
// What became of a run's messages: how many were worked on, and what was dropped where.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

namespace deltamap::daemon {

struct ScanCounts {
  std::uint64_t decoded = 0;
  std::uint64_t localized = 0;
  std::uint64_t dropped = 0;  ///< overtaken by a newer scan
  std::uint64_t lost = 0;     ///< sensor channel full
  std::uint64_t odometry = 0;
  std::uint64_t odometry_lost = 0;
  std::uint64_t tracked_lost = 0;    ///< localized, but not seen by Δ-awareness
  std::uint64_t sets_lost = 0;       ///< Δ-phases that found the map thread busy
  std::uint64_t recording_lost = 0;  ///< chunks of bytes that the recorder could not take
};

/// What was dropped, by the name that report.json and `ctl status` give it.
[[nodiscard]] inline std::array<std::pair<const char*, std::uint64_t>, 6> drops_of(const ScanCounts& counts) {
  return {{{"scans_overtaken", counts.dropped},
           {"scans_lost", counts.lost},
           {"odometry_lost", counts.odometry_lost},
           {"tracked_lost", counts.tracked_lost},
           {"sets_lost", counts.sets_lost},
           {"recording_lost", counts.recording_lost}}};
}

}  // namespace deltamap::daemon
