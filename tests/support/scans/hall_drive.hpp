// SPDX-License-Identifier: Apache-2.0
// A robot with drifting wheels and a 180° laser drives through drawn worlds while a localizer follows on its map: the
// stream that Δ-awareness lives on, with the truth beside it.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "tests/support/scans/cast_scan.hpp"

namespace deltamap::test {

class HallDrive {
 public:
  static constexpr double kScanPeriod_s = 0.2133;  // 38400 baud, 181 values (protocols.md B7)
  static constexpr double kSpeed_m_per_s = 0.4;
  static constexpr double kTurn_rad = 0.15;  // a scan period: 40°/s

  HallDrive(const OccupancyGrid& map, const Pose2& start, std::uint64_t seed) : HallDrive{map, start, seed, params()} {}
  HallDrive(const OccupancyGrid& map, const Pose2& start, std::uint64_t seed,
            const localization::LocalizerParams& given)
      : localizer_{given, std::make_shared<const OccupancyGrid>(map), localization::particles::InitialPose{start},
                   seed},
        random_{seed + 1000},
        truth_{start} {
    odometry_.time = timestamp_from_ns(1'700'000'000'000'000'000);
  }

  [[nodiscard]] static localization::LocalizerParams params() {
    localization::LocalizerParams params;
    params.particles.min = params.particles.max = 500;
    return params;
  }
  [[nodiscard]] const Pose2& truth() const { return truth_; }
  [[nodiscard]] localization::Localizer& localizer() { return localizer_; }

  /// Turns towards the place, drives there, and shows each tracked scan to `see`.
  template <typename See>
  void drive_to(const Point2& place, const OccupancyGrid& world, See&& see) {
    for (Point2 way = place - truth_.position(); way.norm() > 0.1; way = place - truth_.position()) {
      const double off_rad = turn_between(truth_.theta, std::atan2(way.y(), way.x()));
      const double forward_m = std::abs(off_rad) > 0.5 ? 0.0 : std::min(way.norm(), kSpeed_m_per_s * kScanPeriod_s);
      see(step({forward_m, 0.0, std::clamp(off_rad, -kTurn_rad, kTurn_rad)}, world));
    }
  }
  /// Turns on the spot.
  template <typename See>
  void turn(int scans, const OccupancyGrid& world, See&& see) {
    for (int i = 0; i < scans; ++i) see(step({0.0, 0.0, kTurn_rad}, world));
  }

 private:
  TrackedScan step(const Pose2& motion, const OccupancyGrid& world) {
    truth_ = truth_ * motion;
    const double slip = 1.0 + random_.normal(0.03);
    odometry_.odom_from_robot =
        odometry_.odom_from_robot *
        Pose2{slip * motion.x, 0.0, 1.02 * motion.theta + 0.01 * motion.x + random_.normal(0.002)};
    odometry_.time = odometry_.time + duration_from_seconds(kScanPeriod_s);
    localizer_.observe(odometry_);
    return localizer_.observe(cast_scan(world, truth_, odometry_.time, scanner_, random_));
  }

  localization::Localizer localizer_;
  CastScanner scanner_;
  Random random_;
  Pose2 truth_;
  Odometry odometry_;
};

/// Once round the lower half of drawn_hall(), 46 m.
inline const std::vector<Point2>& way_round() {
  static const std::vector<Point2> way{{18.5, 1.0}, {18.5, 7.0}, {1.5, 7.0}, {1.5, 1.0}};
  return way;
}

}  // namespace deltamap::test
