// SPDX-License-Identifier: Apache-2.0
// Detects that a scan does not follow from the one before. The earlier scan is moved on as odometry says, and as the
// estimate says; where part of the view is then suddenly nearer and part farther away, the robot was carried. An object
// that comes makes its part nearer alone, one that goes makes it farther alone. Where the wheels have slipped, or their
// reports come late, the estimate has moved as the scans have. The map is not asked, so that one out of date does not
// matter. After a way without scans so long that odometry's error would show as much, the scan counts as a break too.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/messages.hpp"

namespace deltamap::localization::belief {

struct ScanBreakParams {
  double most = 0.2;                ///< of the beams that may suddenly be nearer or farther away, beyond what is usual
                                    ///< (odometry may be poor, edges many); [0, 1]
  double each_way = 0.05;           ///< of them at least so many each way; a break that is larger than
  double most_one_way = 0.3;        ///< is one whichever way; both [0, 1]
  double least_m = 0.25;            ///< a smaller difference of range is none; > 0
  double wheels_rad_per_m = 0.05;   ///< that odometry may have turned unnoticed, for each metre; >= 0
  double wheels_rad_per_rad = 0.1;  ///< and for each radian that it tells of; >= 0
  double most_way_m = 1.0;          ///< scans farther apart are not compared; > 0
  double most_turn_rad = 0.5;       ///< nor are scans that are turned farther; > 0
};

/// A scan with where the robot was at it, by the wheels and by the estimate.
struct FollowedScan {
  const Scan& scan;
  std::span<const RayInRobot> rays;  ///< one for each beam
  Pose2 odom_from_robot;             ///< in one frame over all epochs
  std::uint32_t odometry_epoch = 0;
  Pose2 map_from_robot;
};

class ScanBreak {
 public:
  explicit ScanBreak(const ScanBreakParams& params) : params_{params} {}

  /// Every scan in order. Does so much of its view not follow from the scan before that the robot may have been
  /// carried?
  [[nodiscard]] bool observe(const FollowedScan& now);
  /// Seconds from the scan before to that one, where it could be held against it: not after a way without scans, nor
  /// where too little is in view.
  [[nodiscard]] std::optional<double> compared_over_s() const { return compared_over_s_; }

 private:
  struct Shares {
    double nearer = 0.0;
    double farther = 0.0;
    [[nodiscard]] double both() const { return nearer + farther; }
  };
  /// Of the beams that can be compared; nothing where those are too few.
  [[nodiscard]] std::optional<Shares> compared(const FollowedScan& now, const Pose2& now_from_last) const;
  [[nodiscard]] std::optional<Shares> least_compared(const FollowedScan& now) const;
  [[nodiscard]] bool was_blind(const FollowedScan& now) const;
  void keep(const FollowedScan& now);

  ScanBreakParams params_;
  std::vector<Eigen::Vector2f> ends_;  // of the last scan, robot frame; those that have a range
  Pose2 odom_from_robot_;
  Pose2 map_from_robot_;
  std::uint32_t epoch_ = 0;
  std::optional<Timestamp> last_;
  std::optional<Shares> usual_;
  std::optional<double> compared_over_s_;
};

}  // namespace deltamap::localization::belief
