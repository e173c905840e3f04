// SPDX-License-Identifier: Apache-2.0
// How much too late the wheels' stamps are: the shift in time at which what they counted turns as the laser saw the
// robot turn. Found within seconds of turning; only turns tell it, for they change sharply.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>

#include "core/time.hpp"
#include "localization/motion/odometry_buffer.hpp"

namespace deltamap::localization::odometer {

class WheelLag {
 public:
  /// The robot turned so far between two scans, by the laser. `reports`: the wheels' own, at their own times.
  void observe(Timestamp from, Timestamp to, double turned_rad, const motion::OdometryBuffer& reports);
  /// s; nothing until it is known to 10 ms.
  [[nodiscard]] std::optional<double> lag_s() const;

 private:
  static constexpr int kShifts = 51;
  struct Turn {
    Timestamp from;
    Timestamp to;
    double turned_rad = 0.0;
  };
  void weigh(const Turn& turn, const motion::OdometryBuffer& reports);

  std::deque<Turn> waiting_;  // for reports from half a second later
  // Sums over turns: laser², and for each shift laser · wheels and wheels².
  double laser2_ = 0.0;
  std::array<double, kShifts> both_{};
  std::array<double, kShifts> wheels2_{};
  double weight_ = 0.0;
  std::size_t turns_ = 0;
};

}  // namespace deltamap::localization::odometer
