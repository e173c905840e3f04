// SPDX-License-Identifier: Apache-2.0
// Wander and Safety together drive a point-exact robot through drawn halls.
#include "navigation/wander.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "core/grid/grid_ray.hpp"
#include "navigation/safety.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::navigation {
namespace {

constexpr double kScanPeriodS = 0.10656;  // 180/1° at 38400 baud
constexpr double kScanAgeS = 0.12;        // until it can be decided on
constexpr double kHullM = 0.26;
constexpr double kMaxRangeM = 8.0;

/// Where the robot was at each scan.
struct Course {
  std::vector<Pose2> poses;
  double nearest_m = 1e9;  // to an occupied cell ahead, over all scans
  int stops = 0;           // that safety had to order for an obstacle
  bool reversed = false;
};

Scan seen(const OccupancyGrid& grid, const Pose2& map_from_robot, Timestamp time) {
  Scan scan;
  scan.time = time;
  scan.received = time + duration_from_seconds(kScanAgeS);
  scan.first_bearing_rad = -std::numbers::pi / 2.0;
  scan.bearing_step_rad = std::numbers::pi / 180.0;
  scan.max_range_m = kMaxRangeM;
  for (std::size_t i = 0; i < 181; ++i) {
    const double bearing = scan.bearing_rad(i);
    const Point2 end = map_from_robot * Point2{kMaxRangeM * std::cos(bearing), kMaxRangeM * std::sin(bearing)};
    Beam beam{0.0F, 0.0F, BeamKind::kBeyondMaximum};
    walk_ray(grid.geometry(), map_from_robot.position(), end, [&](Cell cell, double entered_m) {
      if (grid.at(cell) != CellState::kOccupied) return true;
      beam = {static_cast<float>(entered_m), 0.0F, BeamKind::kRange};
      return false;
    });
    scan.beams.push_back(beam);
  }
  return scan;
}

Course driven(const OccupancyGrid& grid, Pose2 pose, double for_s, std::uint64_t seed,
              const SafetyParams& safety_params = {}) {
  Wander wander{{}, seed};
  Safety safety{safety_params};
  safety.set_stopping_behaviour({.watchdog_s = 2.0});
  Course drive;
  Timestamp now = timestamp_from_ns(5'000'000'000);
  Odometry odometry;
  odometry.motors_enabled = true;
  odometry.battery_v = 12.5;
  for (double t = 0.0; t < for_s; t += kScanPeriodS) {
    TrackedScan tracked;
    tracked.scan = seen(grid, pose, now);
    tracked.odom_from_robot = pose;
    for (const Beam& beam : tracked.scan.beams) {
      if (beam.kind == BeamKind::kRange) drive.nearest_m = std::min(drive.nearest_m, static_cast<double>(beam.range_m));
    }
    const Timestamp decided = now + duration_from_seconds(kScanAgeS);
    odometry.time = decided;
    odometry.odom_from_robot = pose;
    safety.observe(tracked.scan);
    safety.observe(odometry);
    const DriveCommand command = wander.step(tracked);
    drive.reversed = drive.reversed || command.speed_m_per_s < 0.0;
    safety.command(command, decided);
    const AllowedMotion motion = safety.allowed(decided);
    drive.stops += motion.stop != StopReason::kNone ? 1 : 0;
    odometry.speed_m_per_s = motion.speed_m_per_s;
    const double turn = motion.turn_rate_rad_per_s * kScanPeriodS;
    const double ahead_m = motion.speed_m_per_s * kScanPeriodS;
    pose = pose * Pose2{ahead_m * std::cos(turn / 2.0), ahead_m * std::sin(turn / 2.0), turn};
    drive.poses.push_back(pose);
    now += duration_from_seconds(kScanPeriodS);
  }
  return drive;
}

/// The paper's hall: 35 m square, four blocks of 10 m, corridors of 5 m. Cells of 0.5 m.
OccupancyGrid hall() {
  std::vector<std::string> lines;
  for (int row = 0; row < 72; ++row) {
    std::string line;
    for (int column = 0; column < 72; ++column) {
      const auto inside_block = [](int i) { return (i >= 11 && i < 31) || (i >= 41 && i < 61); };
      const bool wall = row == 0 || column == 0 || row == 71 || column == 71;
      line += wall || (inside_block(row) && inside_block(column)) ? '#' : '.';
    }
    lines.push_back(line);
  }
  return test::drawn_grid(lines, 0.5);
}

std::set<std::pair<int, int>> tiles_visited(const Course& drive) {
  std::set<std::pair<int, int>> tiles;
  for (const Pose2& pose : drive.poses) {
    tiles.emplace(static_cast<int>((pose.x - 0.5) / 5.0), static_cast<int>((pose.y - 0.5) / 5.0));
  }
  return tiles;
}

TEST(Wander, VisitsTheWholeHallWithoutTouchingAnything) {
  const OccupancyGrid grid = hall();
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const Course drive = driven(grid, {3.0, 3.0, 0.3}, 1500.0, seed);
    EXPECT_GE(tiles_visited(drive).size(), 30u) << seed;  // of 33 corridor tiles of 5 m
    EXPECT_GT(drive.nearest_m, kHullM) << seed;
    EXPECT_FALSE(drive.reversed);
    EXPECT_LT(drive.stops, static_cast<int>(drive.poses.size() / 50)) << seed;
  }
}

TEST(Wander, GoesStraightAtFullSpeedWhereItIsClear) {
  const OccupancyGrid grid = hall();
  const Course drive = driven(grid, {2.0, 3.0, 0.0}, 8.0, 1);
  const Pose2& halfway = drive.poses[drive.poses.size() / 2];  // it creeps until its scans have followed its wheels
  EXPECT_NEAR(distance_between(halfway, drive.poses.back()), 0.5 * 4.0, 0.1);
  EXPECT_NEAR(drive.poses.back().y, 3.0, 0.1);
}

TEST(Wander, GetsOutOfADeadEnd) {
  const OccupancyGrid grid =
      test::drawn_grid({"####################",  //
                        "#..................#", "#..................#", "#..................#", "#..................#",
                        "#..................#", "#..................#", "#..........#########", "#..................#",
                        "#..................#", "#..................#", "#..........#########", "#..................#",
                        "####################"},
                       0.5);
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    const Course drive = driven(grid, {8.5, 2.25, 0.0}, 90.0, seed);  // faces the end of the pocket on the right
    bool came_out = false;
    for (const Pose2& pose : drive.poses) came_out = came_out || pose.x < 5.0;
    EXPECT_TRUE(came_out) << seed;
    EXPECT_GT(drive.nearest_m, kHullM) << seed;
  }
}

TEST(Wander, TurnsTowardsTheSideThatIsOpen) {
  const OccupancyGrid grid = test::drawn_grid({"####################",  //
                                               "#..........#########", "#..........#########", "#..........#########",
                                               "#..........#########", "#..........#########", "####################"},
                                              0.5);
  // Before a wall, another one close on the right.
  const Course drive = driven(grid, {4.75, 1.1, 0.0}, 3.0, 1);
  EXPECT_GT(drive.poses.back().theta, 0.3);
}

TEST(Wander, DrivesTheSameWayAgainFromTheSameSeed) {
  const OccupancyGrid grid = hall();
  const Course one = driven(grid, {3.0, 3.0, 0.3}, 120.0, 9);
  const Course two = driven(grid, {3.0, 3.0, 0.3}, 120.0, 9);
  const Course other = driven(grid, {3.0, 3.0, 0.3}, 120.0, 10);
  EXPECT_EQ(one.poses, two.poses);
  EXPECT_NE(one.poses, other.poses);
}

}  // namespace
}  // namespace deltamap::navigation
