// SPDX-License-Identifier: Apache-2.0
// Counts of what a localizer has met since its start (gaps, epochs, searches, recoveries), for telemetry and operator.
#pragma once

#include <cstdint>

namespace deltamap::localization {

struct LocalizerCounts {
  std::uint64_t scans = 0;
  std::uint64_t scans_without_return = 0;  ///< no beam that scores
  std::uint64_t scans_without_odometry = 0;
  std::uint64_t wheels_contradicted = 0;  ///< scans that tell of another motion than the wheels
  std::uint64_t clock_fell_back = 0;      ///< a scan older than the one before
  std::uint64_t odometry_epochs = 0;      ///< changes: the controller's pose jumped
  std::uint64_t gaps = 0;                 ///< long silences of scans and wheels after which the pose was checked
  std::uint64_t relocalizations = 0;      ///< poses that a person has given while it ran
  std::uint64_t poses_in_obstacle = 0;    ///< given poses inside a wall: moved to free space and checked
  std::uint64_t poses_refused = 0;        ///< given poses far from any free space: searched instead
  std::uint64_t poses_confirmed = 0;      ///< remembered ones that the first scans fitted
  std::uint64_t poses_refuted = 0;        ///< and those that they did not fit: searched instead
  std::uint64_t searches = 0;             ///< of the whole map
  std::uint64_t recoveries = 0;           ///< another pose has won over the believed one
};

}  // namespace deltamap::localization
