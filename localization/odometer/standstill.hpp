// SPDX-License-Identifier: Apache-2.0
// Does the robot stand though its wheels turn? A scan that is the same as one before says so, unless the scene looks
// alike where the wheels claim to be: then a bare corridor tells nothing. So the earlier scan is drawn from where the
// wheels claim the robot to be and held against the new one, across its surfaces: differences of range would lie at
// grazing incidence.
#pragma once

#include <span>
#include <vector>

#include "core/messages.hpp"

namespace deltamap::localization::odometer {

class Standstill {
 public:
  /// The scan that others are held against from now on.
  void keep(const Scan& scan, std::span<const RayInRobot> rays);
  void forget() { kept_.clear(); }
  [[nodiscard]] bool has_kept() const { return !kept_.empty(); }
  /// The scan is the kept one beam by beam, but for noise and a quarter of the beams. Without any noise it is no other
  /// scan: a laser that repeats itself tells nothing of the robot.
  [[nodiscard]] bool is_same(const Scan& scan) const;
  /// Of a robot that has stood since the kept scan, over one that has moved as its wheels claim or nearly so, nats: how
  /// much better the kept scan's ends then lie on what the scan sees. Of all motions that the wheels may mean the best
  /// counts; none is tried any more once the odds are no more than `enough`.
  [[nodiscard]] double log_odds(const Scan& scan, std::span<const RayInRobot> rays, const Pose2& claimed,
                                double enough) const;
  static constexpr double kClearlyMoved = -3.0;

 private:
  struct Kept {
    Beam beam;
    RayInRobot ray;
  };
  std::vector<Kept> kept_;
  double first_bearing_rad_ = 0.0;
  double bearing_step_rad_ = 0.0;
};

}  // namespace deltamap::localization::odometer
