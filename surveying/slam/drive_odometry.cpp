// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/drive_odometry.hpp"

#include <utility>

#include "localization/motion/deskew.hpp"

namespace deltamap::surveying::slam {
namespace {

constexpr double kMostUncoveredS = 1.0;  // between a scan and the nearest report of the wheels
constexpr double kReportsAheadS = 0.6;   // of a scan: as late as stamps may be, and a report more
constexpr double kMostWaitingS = 60.0;   // for the lag
constexpr double kClockFellBackS = 1.0;
constexpr int kReports = 8192;  // of a minute, at 100 a second

localization::motion::OdometryBufferParams long_enough(localization::motion::OdometryBufferParams params) {
  params.capacity = std::max(params.capacity, kReports);
  return params;
}

}  // namespace

DriveOdometry::DriveOdometry(const localization::motion::OdometryBufferParams& params, double range_deviation_m,
                             Sink sink)
    : range_deviation_m_{range_deviation_m},
      sink_{std::move(sink)},
      reports_{long_enough(params)},
      ahead_{Witnessed{localization::motion::OdometryBuffer{params}, {}}},
      followed_{localization::motion::OdometryBuffer{long_enough(params)}, {}} {}

std::optional<double> DriveOdometry::lag_s() const {
  const std::optional<double> found = followed_.scans.lag_s();
  return found ? found : first_lag_s_;
}

void DriveOdometry::observe(const Odometry& odometry) {
  if (newest_report_ && seconds(*newest_report_ - odometry.time) > kClockFellBackS) end();
  newest_report_ = odometry.time;
  reports_.add(odometry);
  if (ahead_) ahead_->wheels.add(odometry);
  followed_.wheels.add(odometry);
  hand_on_what_is_due();
}

void DriveOdometry::observe(Scan scan) {
  if (newest_scan_ && scan.time < *newest_scan_) {
    end();
    reports_.clock_fell_back(*newest_scan_);
    if (ahead_) ahead_->wheels.clock_fell_back(*newest_scan_);
    followed_.wheels.clock_fell_back(*newest_scan_);
  }
  newest_scan_ = scan.time;
  scan.range_deviation_m = range_deviation_m_;
  if (!lag_s()) scout(scan);
  waiting_.push_back(std::move(scan));
  hand_on_what_is_due();
}

void DriveOdometry::end() {
  while (!waiting_.empty()) {
    hand_on(std::move(waiting_.front()));
    waiting_.pop_front();
  }
}

void DriveOdometry::scout(const Scan& scan) {
  const auto rays = localization::motion::deskewed(scan, ahead_->wheels.velocity_at(scan.time));
  (void)ahead_->scans.observe(scan, rays, ahead_->wheels, reports_);
  first_lag_s_ = ahead_->scans.lag_s();
  if (first_lag_s_) ahead_.reset();
}

void DriveOdometry::hand_on_what_is_due() {
  while (!waiting_.empty()) {
    const Timestamp time = waiting_.front().time;
    const bool is_covered = lag_s() && newest_report_ && seconds(*newest_report_ - time) >= kReportsAheadS;
    if (!is_covered && seconds(*newest_scan_ - time) < kMostWaitingS) return;
    hand_on(std::move(waiting_.front()));
    waiting_.pop_front();
  }
}

void DriveOdometry::hand_on(Scan scan) {
  localization::motion::OdometryBuffer& wheels = followed_.wheels;
  const double lag = lag_s().value_or(0.0);
  wheels.set_lag(lag);
  const auto told = wheels.at(scan.time);
  if (!told || told->uncovered_s > kMostUncoveredS) return;
  const auto velocity = wheels.velocity_at(scan.time + duration_from_seconds(lag));
  MovedScan moved;
  moved.tracked.rays = localization::motion::deskewed(scan, velocity);
  moved.tracked.speed_m_per_s = velocity.speed_m_per_s;
  moved.tracked.turn_rate_rad_per_s = velocity.turn_rate_rad_per_s;
  const localization::odometer::LaserMotion seen = followed_.scans.observe(scan, moved.tracked.rays, wheels, reports_);
  moved.deviation = seen.deviation;
  moved.kept = seen.kept;
  moved.is_torn_off = last_ && scan.time < *last_;
  last_ = scan.time;
  start_from_robot_ = start_from_robot_ * seen.motion;
  moved.tracked.odom_from_robot = start_from_robot_;
  moved.tracked.odometry_epoch = told->epoch;
  moved.tracked.scan = std::move(scan);
  sink_(std::move(moved));
}

}  // namespace deltamap::surveying::slam
