// SPDX-License-Identifier: Apache-2.0
// A laser of 180 beams that drives along an aisle 3 m wide: niches 1 m deep stand 2 m apart, every third one on the
// left and every fifth on the right is walled up.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/geometry/angle.hpp"
#include "localization/belief/scan_break.hpp"

namespace deltamap::localization::belief {

class AisleDrive {
 public:
  static constexpr double kPeriodS = 0.1;

  /// The scan after another step. A thing stands 1 m away across so many beams. Holds until the next call.
  [[nodiscard]] FollowedScan next(int thing_beams = 0) {
    time_s_ += kPeriodS;
    way_m_ += speed_m_per_s * kPeriodS;
    scan_ = {};
    scan_.time = now();
    scan_.first_bearing_rad = -0.5 * std::numbers::pi;
    scan_.bearing_step_rad = radians(1.0);
    rays_.clear();
    for (int i = 0; i < 180; ++i) {
      const double bearing_rad = scan_.bearing_rad(static_cast<std::size_t>(i));
      const Point2 along{std::cos(bearing_rad), std::sin(bearing_rad)};
      double range_m = free_along(along);
      if (i >= 90 && i < 90 + thing_beams) range_m = std::min(range_m, 1.0);
      scan_.beams.push_back({static_cast<float>(range_m), 0.0F, BeamKind::kRange});
      rays_.push_back({{0.0F, 0.0F}, (range_m * along).cast<float>()});
    }
    const Pose2 odom_from_robot{way_m_, 0.0, 0.0};
    return {scan_, rays_, odom_from_robot, epoch, map_from_odom * odom_from_robot};
  }

  [[nodiscard]] Timestamp now() const { return timestamp_from_ns(0) + duration_from_seconds(time_s_); }
  void set_back(double back_s) { time_s_ -= back_s; }

  double speed_m_per_s = 0.5;
  std::uint32_t epoch = 0;
  double carried_m = 0.0;  ///< ahead of where the wheels say it is
  Pose2 map_from_odom;     ///< that the estimate has

 private:
  [[nodiscard]] double free_along(const Point2& along) const {
    const double x = way_m_ + carried_m;
    double range_m = 0.05;
    while (range_m < 30.0 && !is_wall(x + range_m * along.x(), range_m * along.y())) range_m += 0.02;
    return range_m;
  }
  static bool is_wall(double along, double aside) {
    if (std::abs(aside) < 1.5) return along > 60.0;
    const double place = std::floor(0.5 * along);
    const bool niche = std::fmod(along + 100.0, 2.0) < 1.0 && std::fmod(place + 300.0, aside > 0.0 ? 3.0 : 5.0) >= 1.0;
    return !niche || std::abs(aside) >= 2.5;
  }

  double time_s_ = 10'000.0;
  double way_m_ = 0.0;
  Scan scan_;
  std::vector<RayInRobot> rays_;
};

}  // namespace deltamap::localization::belief
