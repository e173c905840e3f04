// SPDX-License-Identifier: Apache-2.0
// First drives through the drawn hall, whose wheels turn and count wrongly: for tests of SLAM.
#pragma once

#include <cmath>
#include <vector>

#include "tests/support/scans/seen_scan.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::test {

/// From corner to corner, a scan every 0.2 m; the robot turns on the spot, a scan every 6°.
inline std::vector<Pose2> way_along(const std::vector<Point2>& corners) {
  constexpr double kStepM = 0.2;
  const double step_rad = radians(6.0);
  std::vector<Pose2> way;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Point2 along = corners[i + 1] - corners[i];
    const double heading = std::atan2(along.y(), along.x());
    if (!way.empty()) {
      const double turn = turn_between(way.back().theta, heading);
      const int steps = static_cast<int>(std::ceil(std::abs(turn) / step_rad));
      for (int k = 1; k < steps; ++k) {
        way.push_back({corners[i].x(), corners[i].y(), wrapped_angle(way.back().theta + turn / steps)});
      }
    }
    const int steps = static_cast<int>(std::ceil(along.norm() / kStepM));
    for (int k = 0; k < steps; ++k) {
      const Point2 at = corners[i] + along * (static_cast<double>(k) / steps);
      way.push_back({at.x(), at.y(), heading});
    }
  }
  return way;
}

/// Round the lower three containers of the hall, from its lower left corner on.
inline std::vector<Pose2> rounds_of_the_hall(int rounds) {
  std::vector<Point2> corners{{1.5, 1.2}};
  for (int i = 0; i < rounds; ++i) {
    for (const Point2& corner : {Point2{18.7, 1.2}, Point2{18.7, 7.0}, Point2{1.5, 7.0}, Point2{1.5, 1.2}}) {
      corners.push_back(corner);
    }
  }
  return way_along(corners);
}

/// What is seen along the way; the estimate holds nothing. The wheels begin at the origin, count 2 % too far and drift
/// by 1° a metre.
inline std::vector<TrackedScan> surveyed(const OccupancyGrid& hall, const std::vector<Pose2>& way, Random& random,
                                         double max_range_m = 20.0) {
  std::vector<TrackedScan> scans;
  Pose2 odom;
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (i > 0) {
      const Pose2 motion = motion_between(way[i - 1], way[i]);
      odom = odom * Pose2{1.02 * motion.x, 1.02 * motion.y, motion.theta + radians(1.0) * motion.position().norm()};
    }
    scans.push_back(seen_scan(hall, way[i], 0.01, random, max_range_m));
    scans.back().estimate = {};
    scans.back().odom_from_robot = odom;
  }
  return scans;
}

/// What wheels tell wrongly: once, in the middle of the way, they slip; all their stamps are late.
struct WrongWheels {
  Pose2 slip;
  double lag_s = 0.0;
};

/// The messages of a drive in the order of their stamps: a scan each 0.2 s and the wheels' reports each 0.05 s.
struct DriveMessages {
  std::vector<Odometry> odometry;
  std::vector<Scan> scans;

  template <typename Taker>
  void give(Taker& taker) const {
    auto report = odometry.begin();
    for (const Scan& scan : scans) {
      for (; report != odometry.end() && report->time <= scan.time; ++report) taker.observe(*report);
      taker.observe(scan);
    }
    for (; report != odometry.end(); ++report) taker.observe(*report);
  }
};

inline Timestamp survey_time(double time_s) {
  return timestamp_from_ns(1'000'000'000'000) + duration_from_seconds(time_s);
}

/// Wheels that are exact but for what is told.
inline DriveMessages driven(const OccupancyGrid& hall, const std::vector<Pose2>& way, const WrongWheels& wrong,
                            Random& random, double max_range_m = 20.0) {
  constexpr double kScanS = 0.2;
  constexpr int kReports = 4;  // a scan
  DriveMessages messages;
  Pose2 odom;
  for (std::size_t i = 0; i < way.size(); ++i) {
    const Pose2 motion = i + 1 < way.size() ? motion_between(way[i], way[i + 1]) : Pose2{};
    if (i == way.size() / 2) odom = odom * wrong.slip;
    for (int k = 0; k < kReports; ++k) {
      const double share = static_cast<double>(k) / kReports;
      Odometry report;
      report.time = survey_time(kScanS * (static_cast<double>(i) + share) + wrong.lag_s);
      report.odom_from_robot = odom * Pose2{share * motion.x, share * motion.y, share * motion.theta};
      messages.odometry.push_back(report);
    }
    odom = odom * motion;
    messages.scans.push_back(seen_scan(hall, way[i], 0.01, random, max_range_m).scan);
    messages.scans.back().time = survey_time(kScanS * static_cast<double>(i));
  }
  return messages;
}

}  // namespace deltamap::test
