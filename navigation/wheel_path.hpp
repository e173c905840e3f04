// SPDX-License-Identifier: Apache-2.0
// Where the wheels say that the robot was at the time of a scan: the last packets, interpolated.
#pragma once

#include <deque>
#include <optional>

#include "core/messages.hpp"

namespace deltamap::navigation {

class WheelPath {
 public:
  void observe(const Odometry& odometry);
  /// In the frame of the controller's present epoch; nothing before the first packet of that, or long after the last.
  [[nodiscard]] std::optional<Pose2> odom_from_robot(Timestamp time) const;
  /// Grows when the controller's pose jumped: poses of two epochs cannot be compared.
  [[nodiscard]] std::uint32_t epoch() const { return path_.empty() ? 0 : path_.back().epoch; }

 private:
  std::deque<Odometry> path_;
};

}  // namespace deltamap::navigation
