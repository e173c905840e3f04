// SPDX-License-Identifier: Apache-2.0
// Where the laser looks from where it is mounted, and whether that covers the way that the robot takes.
#pragma once

#include <cstddef>
#include <optional>

#include "core/messages.hpp"

namespace deltamap::navigation {

/// All directions from the first beam counter-clockwise to the last.
struct Fan {
  Pose2 robot_from_laser;  ///< the mount
  double first_rad = 0.0;  ///< bearing of the first beam, laser frame
  double width_rad = 0.0;  ///< from the first beam to the last; [0, 2π]
};

[[nodiscard]] Fan fan_of(const Scan& scan);

/// Does the point lie in a direction in which the laser looks, however far away?
[[nodiscard]] bool looks_at(const Fan& fan, const Point2& point_in_robot);

/// The beam that looks there; nothing where none does.
[[nodiscard]] std::optional<std::size_t> beam_towards(const Scan& scan, const Point2& point_in_laser);

/// Does the laser see all that the robot could run into straight ahead: the strip as wide as hull and margin (a disc of
/// `radius_m` around the robot's middle), from `radius_m` ahead of its middle on? Its nearest corners are seen last.
[[nodiscard]] bool covers_way_ahead(const Fan& fan, double radius_m);

}  // namespace deltamap::navigation
