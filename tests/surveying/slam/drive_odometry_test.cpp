// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/drive_odometry.hpp"

#include <gtest/gtest.h>

#include "surveying/slam/drawn_map.hpp"
#include "surveying/slam/slam.hpp"
#include "tests/support/scans/surveyed_hall.hpp"

namespace deltamap::surveying::slam {
namespace {

/// Share of the map's solid cells with a wall of the hall within two cells.
double right_share(const OccupancyGrid& map, const OccupancyGrid& hall) {
  std::size_t solid = 0;
  std::size_t right = 0;
  for_each_known(map, [&](Cell cell, CellState state) {
    if (state != CellState::kOccupied) return;
    ++solid;
    const Cell there = hall.geometry().cell_at(map.geometry().centre_of(cell));
    bool is_near = false;
    for (int row = -2; row <= 2; ++row) {
      for (int column = -2; column <= 2; ++column) {
        is_near = is_near || hall.at({there.column + column, there.row + row}) == CellState::kOccupied;
      }
    }
    right += is_near ? 1 : 0;
  });
  return solid < 500 ? 0.0 : static_cast<double>(right) / static_cast<double>(solid);
}

class DriveOdometryInTheHall : public testing::Test {
 protected:
  /// All scans of a drive, as they are handed on.
  std::vector<MovedScan> moved(const test::DriveMessages& messages) {
    std::vector<MovedScan> scans;
    DriveOdometry odometry{{}, 0.015, [&](MovedScan&& scan) { scans.push_back(std::move(scan)); }};
    messages.give(odometry);
    odometry.end();
    lag_s = odometry.lag_s();
    return scans;
  }
  /// How far the odometry is off at most, as seen from its beginning.
  [[nodiscard]] static Pose2 most_off(const std::vector<MovedScan>& scans, const std::vector<Pose2>& way) {
    Pose2 most;
    for (std::size_t i = 0; i < scans.size(); ++i) {
      const Pose2 off = motion_between(motion_between(way.front(), way[i]), scans[i].tracked.odom_from_robot);
      most.x = std::max(most.x, off.position().norm());
      most.theta = std::max(most.theta, std::abs(off.theta));
    }
    return most;
  }

  OccupancyGrid hall = test::drawn_hall(0.02);
  Random random{21};
  std::optional<double> lag_s;
};

TEST_F(DriveOdometryInTheHall, DrawsTheWallsWhereTheyAreThoughWheelsSlipAndTheirStampsAreLate) {
  const std::vector<Pose2> way = test::rounds_of_the_hall(1);
  for (const double slip_deg : {20.0, -20.0}) {
    Slam slam;
    slam.begin_drive();
    for (MovedScan& scan : moved(test::driven(hall, way, {{0.0, 0.0, radians(slip_deg)}, 0.15}, random)))
      slam.observe(std::move(scan));
    ASSERT_TRUE(slam.finish());
    const Pose2 hall_from_survey = way.front() * inverse(slam.survey().poses.front());
    EXPECT_GT(right_share(drawn_map(slam.survey(), hall_from_survey, 0.05), test::drawn_hall(0.05)), 0.97) << slip_deg;
  }
}

TEST_F(DriveOdometryInTheHall, FindsHowLateTheStampsAreBeforeItHandsOnTheFirstScan) {
  const std::vector<Pose2> way = test::rounds_of_the_hall(1);
  const std::vector<MovedScan> scans = moved(test::driven(hall, way, {{}, 0.15}, random));
  ASSERT_EQ(scans.size(), way.size());
  ASSERT_TRUE(lag_s);
  EXPECT_NEAR(*lag_s, 0.15, 0.02);
  EXPECT_LT(most_off(scans, way).x, 0.10);
  EXPECT_LT(most_off(scans, way).theta, radians(1.5));
}

TEST_F(DriveOdometryInTheHall, GoesOnWhereTheWheelsBeginAnewElsewhere) {
  const std::vector<Pose2> way = test::way_along({{1.5, 7.0}, {16.0, 7.0}});
  test::DriveMessages messages = test::driven(hall, way, {}, random);
  const std::size_t middle = messages.odometry.size() / 2;
  for (std::size_t i = middle; i < messages.odometry.size(); ++i) {
    messages.odometry[i].epoch = 1;
    messages.odometry[i].odom_from_robot = Pose2{3.0, -2.0, 0.4} * messages.odometry[i].odom_from_robot;
  }
  const Pose2 off = most_off(moved(messages), way);
  EXPECT_LT(off.x, 0.15);
  EXPECT_LT(off.theta, radians(2.0));
}

TEST_F(DriveOdometryInTheHall, HandsOnEachScanOnceAndInOrderThoughTheClockFallsBack) {
  const std::vector<Pose2> way = test::way_along({{1.5, 7.0}, {8.0, 7.0}});
  test::DriveMessages first = test::driven(hall, way, {}, random);
  std::vector<MovedScan> scans;
  DriveOdometry odometry{{}, 0.015, [&](MovedScan&& scan) { scans.push_back(std::move(scan)); }};
  first.give(odometry);
  for (Odometry& report : first.odometry) report.time = report.time - duration_from_seconds(100.0);
  for (Scan& scan : first.scans) scan.time = scan.time - duration_from_seconds(100.0);
  first.give(odometry);
  odometry.end();
  ASSERT_EQ(scans.size(), 2 * way.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    EXPECT_EQ(scans[i].is_torn_off, i == way.size()) << i;
    EXPECT_TRUE(i == 0 || i == way.size() || scans[i].tracked.scan.time > scans[i - 1].tracked.scan.time) << i;
  }
}

}  // namespace
}  // namespace deltamap::surveying::slam
