// SPDX-License-Identifier: Apache-2.0
// A drawn CARMEN log of a drive along an arc in a room, line by line, so that a test can put defects in; and what an
// import would tell of it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "drivers/carmen/carmen_survey.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::drivers::carmen {

inline constexpr int kScans = 40;
inline constexpr double kStep_s = 0.2;
inline constexpr double kSpeed_m_per_s = 0.3;
inline constexpr double kStart_s = 1'100'000'000.0;

/// Range in a room of 8 m x 6 m, whose lower left corner is the origin.
inline double range_m(const Pose2& laser, double bearing_rad) {
  const double c = std::cos(laser.theta + bearing_rad);
  const double s = std::sin(laser.theta + bearing_rad);
  const double across = c > 0.0 ? (8.0 - laser.x) / c : c < 0.0 ? -laser.x / c : 1e9;
  const double up = s > 0.0 ? (6.0 - laser.y) / s : s < 0.0 ? -laser.y / s : 1e9;
  return std::min(across, up);
}

/// A drive along a gentle arc.
inline Pose2 truth(int scan) {
  const double turned = 0.02 * scan;
  return {1.5 + kSpeed_m_per_s * kStep_s * scan, 2.0 + 0.03 * scan, turned};
}

inline std::string text(const char* format, double value) {
  char buffer[64];
  (void)std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

inline std::string text(const Pose2& pose) {
  return text(" %.3f", pose.x) + text(" %.3f", pose.y) + text(" %.4f", pose.theta);
}

/// One scan of the log, before it becomes a line.
struct Line {
  std::vector<std::string> ranges{};
  int announced = 181;
  Pose2 robot{};
  Pose2 robot_from_laser{0.1, 0.0, 0.0};
  double stamp_s = 0.0;
  double logger_s = 0.0;
  std::string before{};  ///< lines
  std::function<double(const Pose2&)> heading_of = [](const Pose2& pose) { return pose.theta; };
  [[nodiscard]] std::string flaser() const {
    std::string line = "FLASER " + std::to_string(announced);
    for (const std::string& range : ranges) line += " " + range;
    for (const Pose2& pose : {robot * robot_from_laser, robot})
      line += text(" %.3f", pose.x) + text(" %.3f", pose.y) + text(" %.4f", heading_of(pose));
    return line + text(" %.6f", stamp_s) + " host" + text(" %.6f", logger_s);
  }
};

inline std::vector<Line> drawn_lines(const Pose2& robot_from_laser = {0.1, 0.0, 0.0}) {
  std::vector<Line> lines;
  for (int i = 0; i < kScans; ++i) {
    Line line{.robot = truth(i), .robot_from_laser = robot_from_laser};
    line.stamp_s = kStart_s + kStep_s * i;
    line.logger_s = 2.0 + kStep_s * i;
    for (int beam = 0; beam < 181; ++beam)
      line.ranges.push_back(text("%.2f", range_m(line.robot * robot_from_laser, radians(beam - 90.0))));
    lines.push_back(std::move(line));
  }
  return lines;
}

inline std::string log_of(const std::vector<Line>& lines) {
  std::string log = "# a drawn log\n";
  for (const Line& line : lines) log += line.before + line.flaser() + "\n";
  return log;
}

class CarmenDefects : public testing::Test {
 protected:
  /// What an import would tell, and what it would take.
  void look(const std::string& log) {
    file_ = folder_.write("drawn.log", log);
    survey_ = survey_of(file_, std::nullopt);
    told_ = survey_.notes;
    told_.insert(told_.end(), survey_.drive_notes.begin(), survey_.drive_notes.end());
    if (survey_.cut) told_.push_back(*survey_.cut);
  }
  [[nodiscard]] bool tells(const std::string& part) const {
    return std::any_of(told_.begin(), told_.end(),
                       [&](const std::string& line) { return line.find(part) != std::string::npos; });
  }
  [[nodiscard]] std::string all_told() const {
    std::string all;
    for (const std::string& line : told_) all += line + "\n";
    return all;
  }
  /// Times go on, and the robot drives as it did.
  void expect_one_drive() {
    CarmenLog lines{file_, survey_.clock, survey_.headings};
    std::optional<TimedPose> last;
    std::size_t scans = 0;
    while (const auto record = lines.next()) {
      const auto& scan = std::get<CarmenScan>(*record);
      if (scan.is_repeated) continue;
      ++scans;
      const Pose2 pose = without_resets(survey_.resets, scan.line, scan.poses->odom_from_robot);
      if (last) {
        EXPECT_GT(scan.time, last->time) << "line " << scan.line;
        EXPECT_LT(seconds(scan.time - last->time), 3.5 * kStep_s) << "line " << scan.line;
        EXPECT_LT(distance_between(last->odom_from_robot, pose), 3.5 * kSpeed_m_per_s * kStep_s) << scan.line;
        EXPECT_LT(std::abs(turn_between(last->odom_from_robot.theta, pose.theta)), 0.1) << scan.line;
      }
      last = TimedPose{scan.time, pose};
    }
    EXPECT_EQ(scans, survey_.scans);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_;
  CarmenSurvey survey_;
  std::vector<std::string> told_;
};

}  // namespace deltamap::drivers::carmen
