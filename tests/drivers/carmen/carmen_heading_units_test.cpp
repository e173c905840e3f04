// SPDX-License-Identifier: Apache-2.0
// Logs whose headings are degrees, and those that only look as if.
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "core/geometry/angle.hpp"
#include "tests/support/files/drawn_carmen_log.hpp"

namespace deltamap::drivers::carmen {
namespace {

/// The same poses with headings as a log has them whose writer took degrees.
std::vector<Line> in_degrees(std::vector<Line> lines, const std::function<double(const Pose2&)>& heading_deg) {
  for (Line& line : lines) line.heading_of = heading_deg;
  return lines;
}

TEST_F(CarmenDefects, HeadingsInDegreesAreReadAndNamed) {
  const auto wrapped = [](const Pose2& pose) { return degrees(pose.theta); };
  const auto positive = [](const Pose2& pose) {
    return pose.theta < 0.0 ? degrees(pose.theta) + 360.0 : degrees(pose.theta);
  };
  const Pose2 mount{0.1, 0.0, 0.0};
  for (const double turned : {0.0, 0.05, 1.6, 3.0, -2.0}) {
    for (const auto& heading_deg : {std::function<double(const Pose2&)>{wrapped}, {positive}}) {
      SCOPED_TRACE(turned);
      std::vector<Line> lines = drawn_lines(mount);
      for (Line& line : lines) line.robot = Pose2{0.0, 0.0, turned} * line.robot;
      look(log_of(in_degrees(lines, heading_deg)));
      EXPECT_EQ(survey_.headings, HeadingUnit::kDegree);
      EXPECT_TRUE(tells("headings look like degrees (the first ")) << all_told();
      EXPECT_TRUE(tells("the log has the laser at 0.100, 0.000 m, 0.0°")) << all_told();
      EXPECT_EQ(told_.size(), 2u) << all_told();
      expect_one_drive();
    }
  }
}

TEST_F(CarmenDefects, HeadingsInDegreesOfARobotThatTurnsOnTheSpotAreRead) {
  std::vector<Line> lines = drawn_lines();
  for (std::size_t i = 0; i < lines.size(); ++i) lines[i].robot = {1.0, 2.0, 0.2 * static_cast<double>(i)};
  look(log_of(in_degrees(lines, [](const Pose2& pose) { return degrees(wrapped_angle(pose.theta)); })));
  EXPECT_TRUE(tells("headings look like degrees (the first beyond a turn in line 3)")) << all_told();
}

TEST_F(CarmenDefects, HeadingsThatMayBeDegreesAreDoubted) {
  std::vector<Line> lines = drawn_lines();
  for (Line& line : lines) line.robot = {1.0, 2.0, 1.5};
  look(log_of(in_degrees(lines, [](const Pose2& pose) { return degrees(pose.theta); })));
  EXPECT_EQ(survey_.headings, HeadingUnit::kRadian);
  EXPECT_TRUE(tells("headings of up to 85.94 (the first beyond a turn in line 2)")) << all_told();
}

TEST_F(CarmenDefects, SmallHeadingsThatFitTheWayOnlyAsDegreesAreDoubted) {
  std::vector<Line> lines = drawn_lines();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double along = static_cast<double>(i);
    lines[i].robot = {1.5 + 0.06 * along, 2.0, radians(0.15 * along)};
  }
  look(log_of(in_degrees(lines, [](const Pose2& pose) { return degrees(pose.theta); })));
  EXPECT_EQ(survey_.headings, HeadingUnit::kRadian);
  EXPECT_TRUE(tells("headings lie along the way only as degrees (the first pose is in line 2)")) << all_told();
}

TEST_F(CarmenDefects, HeadingsInRadiansThatAreNotWrappedAreNoDegrees) {
  std::vector<Line> lines = drawn_lines();
  Pose2 robot{1.0, 1.0, 0.0};
  for (std::size_t i = 0; i < lines.size(); ++i) {  // round and round
    lines[i].robot = robot;
    lines[i].heading_of = [turned = 0.8 * static_cast<double>(i)](const Pose2&) { return turned; };
    robot = robot * Pose2{0.0, 0.0, 0.4} * Pose2{0.12, 0.0, 0.4};
  }
  look(log_of(lines));
  EXPECT_EQ(survey_.headings, HeadingUnit::kRadian);
  EXPECT_FALSE(tells("degrees")) << all_told();
}

TEST_F(CarmenDefects, AFrameThatIsTurnedAgainstTheHeadingsMakesThemNoDegrees) {
  std::vector<Line> lines = drawn_lines();
  for (Line& line : lines) line.robot = {line.robot.x, 2.0, 1.57};
  look(log_of(lines));
  EXPECT_FALSE(tells("degrees")) << all_told();
}

}  // namespace
}  // namespace deltamap::drivers::carmen
