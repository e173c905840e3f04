// SPDX-License-Identifier: Apache-2.0
// One run of a drive with some settings and a seed, and what it is worth. Its trajectory and its map are those of
// `deltamap replay` with the same, byte for byte; where that obeys the journal of its recording, of one that does not.
#pragma once

#include <string>
#include <vector>

#include "daemon/replay/replay_run.hpp"
#include "tool/tune/measures.hpp"
#include "tool/tune/tuned_drive.hpp"

namespace deltamap::tool::tune {

struct MeasuredRun {
  Numbers numbers;
  std::string trajectory;                        ///< FNV-1a of trajectory.tum, in hexadecimal: names what came out
  std::string map;                               ///< the same of the newest map, as grid_hash() has it
  std::vector<TunedDrive::StampedPose> poses{};  ///< of all scans
};

/// Any thread. Throws std::runtime_error where the progress says to stop, and as run_replay() does.
[[nodiscard]] MeasuredRun measured_run(TunedDrive& drive, const daemon::Settings& settings,
                                       const daemon::ReplayProgress& progress);

/// Share of ends that lie within 0.1 m of a surface of the map; NaN without ends.
[[nodiscard]] double agreement(const OccupancyGrid& map, const std::vector<Point2>& ends_in_map);

}  // namespace deltamap::tool::tune
