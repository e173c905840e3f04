// SPDX-License-Identifier: Apache-2.0
// Is the laser mounted as its settings say? Scans some way apart are held against what the wheels tell of the way: as
// the mount says, and as another mount would show it. A mount that shows it clearly better over several ways is named.
// Needs no map and no pose: a laser that is turned or upside down leads both astray.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/messages.hpp"

namespace deltamap::navigation {

/// Against what the settings say.
enum class OtherMount : std::uint8_t { kUpsideDown, kTurnedLeft, kTurnedRound, kTurnedRight };

class MountCheck {
 public:
  /// `odom_from_robot`: by the wheels alone, at Scan::time; poses of two epochs cannot be compared. `in_doubt`: the
  /// way that ends here is worth a look.
  void observe(const Scan& scan, const Pose2& odom_from_robot, std::uint32_t epoch, bool in_doubt);
  /// The mount that the scans of several ways show; nothing as long as they show the one of the settings, or none.
  [[nodiscard]] std::optional<OtherMount> shown() const;

 private:
  struct Reference {
    Scan scan;
    Pose2 odom_from_robot;
    std::uint32_t epoch;
  };
  void compare(const Scan& scan, const Pose2& robot_before_from_after);

  std::optional<Reference> reference_;
  std::array<double, 4> evidence_{};  // by OtherMount: what shows it, less what shows the settings' mount
};

}  // namespace deltamap::navigation
