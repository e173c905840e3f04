// SPDX-License-Identifier: Apache-2.0
// What was seen a moment ago and is not seen any more, although nothing was seen behind it: a beam that brings nothing
// back tells nothing of what has stood in its way, and a laser that suddenly sees another place has not seen this one
// free.
#pragma once

#include <optional>
#include <vector>

#include "core/messages.hpp"

namespace deltamap::navigation {

class LostEnds {
 public:
  /// `odom_from_robot`: at Scan::time, in one frame; nothing where the wheels do not tell: all is forgotten. Of a scan
  /// that is not believed, no beam is valid.
  void observe(const Scan& scan, const std::optional<Pose2>& odom_from_robot);
  /// In the robot's frame at the newest scan's time: of the last 1.5 s; near the robot, until a beam has gone through
  /// the place or the robot has left it.
  [[nodiscard]] const std::vector<Point2>& in_robot() const { return lost_in_robot_; }

 private:
  struct End {
    Point2 in_odom;
    Timestamp seen;
    std::optional<Timestamp> kept_until{};  ///< whatever a beam shows: scans have broken off since it was seen
  };
  std::vector<End> ends_;  // seen by the newest scan, or lost since
  std::vector<Point2> lost_in_robot_;
};

}  // namespace deltamap::navigation
