// SPDX-License-Identifier: Apache-2.0
// Beams that never bring a range although the map has walls in their way, wherever the robot stands: a part of the
// laser's window is covered. What has gone from the map is missed from one place, and not by the same beams from the
// next.
#pragma once

#include <optional>
#include <vector>

#include "core/messages.hpp"

namespace deltamap::navigation {

class DeadBeams {
 public:
  /// Each scan, with or without a pose, whether or not the robot moves: a beam that brings a range is not dead.
  void observe(const Scan& scan);
  /// After that, where the scan is localized: which of its beams should have seen a wall. Looks where the robot has
  /// moved or turned a little since it last did.
  void hold_against_map(const TrackedScan& tracked);
  /// A person said drive.
  void begin_anew() { missed_.clear(); }
  /// So many beams that something as wide as a sixth of the fan is not seen.
  [[nodiscard]] bool hide_a_sector() const;

 private:
  std::vector<int> missed_;  // of every few beams: places in a row from which it missed a wall
  std::optional<Pose2> looked_from_;
};

}  // namespace deltamap::navigation
