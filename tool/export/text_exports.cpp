// SPDX-License-Identifier: Apache-2.0
#include "tool/export/text_exports.hpp"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <ostream>

#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::tool {
namespace {

std::string seconds_text(Timestamp time, std::size_t digits) {
  const std::int64_t ns = unix_ns(time);
  char text[48];
  (void)std::snprintf(text, sizeof text, "%" PRId64 ".%09" PRId64, ns / 1'000'000'000, ns % 1'000'000'000);
  const std::string whole{text};
  return whole.substr(0, whole.find('.') + 1 + digits);
}

template <std::size_t count>
std::string joined(const double (&values)[count], const char* format, char between) {
  std::string text;
  for (const double value : values) {
    char one[48];
    (void)std::snprintf(one, sizeof one, format, value);
    if (!text.empty()) text += between;
    text += one;
  }
  return text;
}

std::string range_text(const Beam& beam, const std::string& beyond, const std::string& none) {
  if (beam.kind == BeamKind::kBeyondMaximum) return beyond;
  if (beam.kind != BeamKind::kRange) return none;
  char text[32];
  (void)std::snprintf(text, sizeof text, "%.3f", static_cast<double>(beam.range_m));
  return text;
}

std::string ranges_text(const Scan& scan, const std::string& beyond, const std::string& none) {
  std::string text;
  for (const Beam& beam : scan.beams) text += (text.empty() ? "" : " ") + range_text(beam, beyond, none);
  return text;
}

/// Stamp, host, logger's time.
std::string end_of_line(Timestamp time, Timestamp began) {
  char logger[32];
  (void)std::snprintf(logger, sizeof logger, "%.6f", std::max(0.0, seconds(time - began)));
  return " " + seconds_text(time, 6) + " deltamap " + logger + "\n";
}

}  // namespace

void write_tum(std::vector<daemon::TrajectoryPoint> points, std::ostream& out) {
  const auto is_before = [](const auto& a, const auto& b) { return a.time < b.time; };
  std::stable_sort(points.begin(), points.end(), is_before);
  const auto is_same = [](const auto& a, const auto& b) { return a.time == b.time; };
  points.erase(std::unique(points.begin(), points.end(), is_same), points.end());
  for (const daemon::TrajectoryPoint& point : points) out << daemon::tum_line(point);
}

void write_run_csv(std::span<const daemon::LocalizationRow> rows, std::ostream& out) {
  out << "time,number,state,x_m,y_m,heading_rad,pose_right,map_wrong,revision,speed_m_per_s,turn_rate_rad_per_s\n";
  for (const daemon::LocalizationRow& row : rows) {
    const Pose2& pose = row.map_from_robot;
    out << seconds_text(row.time, 9) << ',' << row.number << ',' << daemon::name_of(row.state) << ','
        << joined({pose.x, pose.y, pose.theta}, "%.6f", ',') << ','
        << joined({row.belief.pose_right, row.belief.map_wrong}, "%.4f", ',') << ',' << row.revision << ','
        << joined({row.speed_m_per_s, row.turn_rate_rad_per_s}, "%.4f", ',') << '\n';
  }
}

std::string scan_csv_header() {
  return "time,number,odom_x_m,odom_y_m,odom_heading_rad,first_bearing_rad,bearing_step_rad,max_range_m,ranges_m\n";
}

std::string scan_csv_line(const Scan& scan, const Pose2& odom_from_robot) {
  return seconds_text(scan.time, 9) + "," + std::to_string(scan.number) + "," +
         joined({odom_from_robot.x, odom_from_robot.y, odom_from_robot.theta, scan.first_bearing_rad,
                 scan.bearing_step_rad, scan.max_range_m},
                "%.9g", ',') +
         "," + ranges_text(scan, "inf", "nan") + "\n";
}

std::string carmen_scan_line(const Scan& scan, const Pose2& odom_from_robot, Timestamp began) {
  constexpr double kAccuracyM = 0.01;
  const Pose2 odom_from_laser = odom_from_robot * scan.robot_from_laser;
  const double field_rad = scan.bearing_step_rad * static_cast<double>(scan.beams.size() - 1);
  char maximum[32];
  (void)std::snprintf(maximum, sizeof maximum, "%.3f", scan.max_range_m);
  return "ROBOTLASER1 0 " + joined({scan.first_bearing_rad, field_rad, scan.bearing_step_rad}, "%.9f", ' ') + " " +
         maximum + joined({kAccuracyM}, " %.3f", ' ') + " 0 " + std::to_string(scan.beams.size()) + " " +
         ranges_text(scan, maximum, "0") + " 0 " +
         joined({odom_from_laser.x, odom_from_laser.y, odom_from_laser.theta, odom_from_robot.x, odom_from_robot.y,
                 odom_from_robot.theta},
                "%.6f", ' ') +
         " 0 0 0 0 0" + end_of_line(scan.time, began);
}

std::string carmen_odometry_line(const Odometry& odometry, const Pose2& odom_from_robot, Timestamp began) {
  return "ODOM " +
         joined({odom_from_robot.x, odom_from_robot.y, odom_from_robot.theta, odometry.speed_m_per_s,
                 odometry.turn_rate_rad_per_s},
                "%.6f", ' ') +
         " 0" + end_of_line(odometry.time, began);
}

}  // namespace deltamap::tool
