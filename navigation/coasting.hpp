// SPDX-License-Identifier: Apache-2.0
// Where a robot goes that nobody speaks to any more: on as it was last told until its watchdog stops it (protocols.md
// A9), then on while it brakes. Its worst case is what a speed is allowed by.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/angle.hpp"
#include "core/geometry/pose2.hpp"
#include "navigation/fan.hpp"

namespace deltamap::navigation {

struct Motion {
  double speed_m_per_s = 0.0;        ///< forward
  double turn_rate_rad_per_s = 0.0;  ///< counter-clockwise
};

/// What the controller does by itself.
struct StoppingBehaviour {
  std::optional<double> watchdog_s;    ///< silence after which it stops by itself; infinite: never; nothing: not known
  double deceleration_m_per_s2 = 0.3;  ///< > 0
  double turn_deceleration_rad_per_s2 = radians(100.0);  ///< > 0
};

struct Coasting {
  Motion at_first;                                       ///< while the command has not yet reached the wheels
  double at_first_s = 0.0;                               ///< >= 0
  Motion then;                                           ///< the command
  double then_s = 0.0;                                   ///< until it brakes; finite, >= 0
  double acceleration_m_per_s2 = kAtOnce;                ///< > 0
  double turn_acceleration_rad_per_s2 = kAtOnce;         ///< > 0
  double deceleration_m_per_s2 = 0.3;                    ///< > 0
  double turn_deceleration_rad_per_s2 = radians(100.0);  ///< > 0

  static constexpr double kAtOnce = std::numeric_limits<double>::infinity();
};

struct CoastingPath {
  std::vector<Pose2> poses;  ///< of the robot, in its frame at the beginning; every 0.1 s
  double length_m = 0.0;
  double turned_rad = 0.0;  ///< >= 0, whichever the side
};

[[nodiscard]] CoastingPath coasting_path(const Coasting& coasting);

/// Does a disc of `radius_m` stay clear of every point on this path? Points that it touches at the beginning count only
/// where it would come nearer to them.
[[nodiscard]] bool is_clear(const CoastingPath& path, std::span<const Point2> obstacles_in_robot, double radius_m);

/// Does the laser see all along this path what the middle of the robot's front comes to?
[[nodiscard]] bool is_looked_at(const CoastingPath& path, const Fan& fan, double radius_m);

}  // namespace deltamap::navigation
