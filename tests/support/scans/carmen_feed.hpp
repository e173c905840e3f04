// SPDX-License-Identifier: Apache-2.0
// Feeds a localizer from a CARMEN log as the drivers would: a report of the wheels exactly at each scan's first beam
// and others in gaps over 100 ms, from the poses that the scan lines carry (docs/protocols/README.md). Without units or
// bytes between.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "core/messages.hpp"
#include "drivers/carmen/carmen_log.hpp"
#include "localization/localizer.hpp"

namespace deltamap::test {

class CarmenFeed {
 public:
  /// Ranges from `no_return_m` on are no hits.
  CarmenFeed(const std::filesystem::path& log, double laser_ahead_m, double no_return_m = 80.0)
      : log_{log}, laser_ahead_m_{laser_ahead_m}, no_return_m_{no_return_m} {}

  /// The next scan with the reports that lead to it already given to the localizer; nothing at the end.
  std::optional<Scan> next(localization::Localizer& localizer) {
    while (const auto record = log_.next()) {
      const auto* logged = std::get_if<drivers::carmen::CarmenScan>(&*record);
      if (logged == nullptr || !logged->poses) continue;
      lead_to(logged->time, logged->poses->odom_from_robot, localizer);
      return scan_of(*logged);
    }
    return std::nullopt;
  }

 private:
  static constexpr double kScanDurationS = 0.0133;  // half a turn of the 75 Hz mirror
  static constexpr double kGapS = 0.1;

  void lead_to(Timestamp time, const Pose2& odom_from_robot, localization::Localizer& localizer) {
    if (last_ && time > last_->time) {
      const Odometry from = *last_;
      const double gap_s = seconds(time - from.time);
      const int parts = static_cast<int>(std::ceil(gap_s / kGapS));
      for (int i = 1; i < parts; ++i) {
        const double share = static_cast<double>(i) / parts;
        report(from.time + duration_from_seconds(share * gap_s),
               interpolated(from.odom_from_robot, odom_from_robot, share), localizer);
      }
    }
    report(time, odom_from_robot, localizer);
  }

  void report(Timestamp time, const Pose2& odom_from_robot, localization::Localizer& localizer) {
    last_ = Odometry{};
    last_->time = time;
    last_->odom_from_robot = odom_from_robot;
    localizer.observe(*last_);
  }

  Scan scan_of(const drivers::carmen::CarmenScan& logged) {
    Scan scan;
    scan.time = logged.time;
    scan.received = logged.time + duration_from_seconds(kScanDurationS);
    scan.number = number_++;
    scan.first_bearing_rad = logged.first_bearing_rad;
    scan.bearing_step_rad = logged.bearing_step_rad;
    scan.max_range_m = no_return_m_;
    scan.robot_from_laser = {laser_ahead_m_, 0.0, 0.0};
    const auto count = static_cast<double>(logged.ranges_m.size());
    for (std::size_t i = 0; i < logged.ranges_m.size(); ++i) {
      const double range_m = logged.ranges_m[i];
      const auto offset_s = static_cast<float>(kScanDurationS * static_cast<double>(i) / count);
      if (range_m > 0.0 && range_m < no_return_m_) {
        scan.beams.push_back({static_cast<float>(range_m), offset_s, BeamKind::kRange});
      } else {
        scan.beams.push_back({0.0F, offset_s, range_m > 0.0 ? BeamKind::kBeyondMaximum : BeamKind::kNotValid});
      }
    }
    return scan;
  }

  drivers::carmen::CarmenLog log_;
  double laser_ahead_m_;
  double no_return_m_;
  std::optional<Odometry> last_;
  std::uint32_t number_ = 0;
};

}  // namespace deltamap::test
