// SPDX-License-Identifier: Apache-2.0
// A robot with a 180° laser whose wheels tell something else than it does.
#pragma once

#include "localization/motion/deskew.hpp"
#include "localization/odometer/laser_odometer.hpp"
#include "tests/support/scans/cast_scan.hpp"

namespace deltamap::localization::odometer {

class OdometerDrive {
 public:
  static constexpr double kPeriodS = 0.2;

  OdometerDrive(const OccupancyGrid& world, const Pose2& start) : world_{world}, truth_{start} {}

  /// One scan later: what it did, and what its wheels claim.
  LaserMotion step(const Pose2& done, const Pose2& claimed) {
    truth_ = truth_ * done;
    odom_from_robot_ = odom_from_robot_ * claimed;
    time_ = time_ + duration_from_seconds(kPeriodS);
    scan_ = test::cast_scan(world_, truth_, time_, {}, random_);
    rays_ = motion::deskewed(scan_, {});
    const LaserMotion seen = odometer_.observe(scan_, rays_, WheelsAt{odom_from_robot_, epoch_}, leads);
    if (seen.slip) odom_from_robot_ = odom_from_robot_ * *seen.slip;
    return seen;
  }
  LaserMotion step(const Pose2& done) { return step(done, done); }

  void begin_epoch(const Pose2& odom_from_robot) {
    ++epoch_;
    odom_from_robot_ = odom_from_robot;
  }
  bool leads = false;  ///< nothing but the odometer tells of the pose

  [[nodiscard]] const Pose2& truth() const { return truth_; }
  /// With what the scans have corrected.
  [[nodiscard]] const Pose2& odom_from_robot() const { return odom_from_robot_; }
  [[nodiscard]] const LaserOdometer& odometer() const { return odometer_; }
  [[nodiscard]] const Scan& scan() const { return scan_; }
  [[nodiscard]] const std::vector<RayInRobot>& rays() const { return rays_; }

 private:
  const OccupancyGrid& world_;
  Pose2 truth_;
  Pose2 odom_from_robot_;
  std::uint32_t epoch_ = 0;
  Timestamp time_ = timestamp_from_ns(1'700'000'000'000'000'000);
  Random random_{7};
  Scan scan_;
  std::vector<RayInRobot> rays_;
  LaserOdometer odometer_;
};

}  // namespace deltamap::localization::odometer
