// SPDX-License-Identifier: Apache-2.0
// A robot that drives straight on and knows where it is, as the gate sees it: scan by scan.
#pragma once

#include "core/messages.hpp"

namespace deltamap::mapping {

inline constexpr double kPeriod_s = 0.1;
inline constexpr double kSpeed_m_per_s = 0.5;

/// A robot that drives straight on and knows where it is.
class StraightDrive {
 public:
  [[nodiscard]] TrackedScan next() {
    time_s_ += kPeriod_s;
    way_m_ += speed_m_per_s * kPeriod_s;
    TrackedScan tracked;
    tracked.scan.time = at(time_s_);
    tracked.odom_from_robot = {way_m_, 0.0, 0.0};
    tracked.estimate.time = tracked.scan.time;
    tracked.estimate.map_from_robot = tracked.odom_from_robot;
    tracked.estimate.covariance = PoseCovariance{Eigen::Vector3d{4e-4, 4e-4, 1e-4}.asDiagonal()};
    tracked.estimate.state = LocalizerState::kTracking;
    tracked.estimate.belief.pose_right = 0.9;
    tracked.estimate.belief.elsewhere = {.expected = 60, .fit = 60};
    return tracked;
  }
  [[nodiscard]] static Timestamp at(double time_s) { return timestamp_from_ns(0) + duration_from_seconds(time_s); }
  [[nodiscard]] double time_s() const { return time_s_; }
  [[nodiscard]] Timestamp now() const { return at(time_s_); }

  double speed_m_per_s = kSpeed_m_per_s;

 private:
  double time_s_ = 0.0;
  double way_m_ = 0.0;
};

}  // namespace deltamap::mapping
