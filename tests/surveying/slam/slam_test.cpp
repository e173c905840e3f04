// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/slam.hpp"

#include <gtest/gtest.h>

#include "tests/support/scans/surveyed_hall.hpp"

namespace deltamap::surveying::slam {
namespace {

/// How far the keyframe poses lie from the truth, as seen from the first one, at most.
double farthest_off_m(const Slam& slam, const std::vector<Pose2>& truth) {
  double most_m = 0.0;
  const Pose2 truth_from_survey = truth.front() * inverse(slam.survey().poses.front());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    most_m = std::max(most_m, distance_between(truth_from_survey * slam.survey().poses[i], truth[i]));
  }
  return most_m;
}

/// Wheels alone: what was wrong stays wrong, and each step adds what they are unsure of.
MovedScan moved(const std::vector<TrackedScan>& scans, std::size_t i) {
  MovedScan made{scans[i], PoseCovariance::Zero(), Eigen::Matrix3d::Identity(), false};
  if (i == 0) return made;
  const Pose2 motion = motion_between(scans[i - 1].odom_from_robot, scans[i].odom_from_robot);
  const double m = 0.02;
  const double rad = 0.01 + 0.07 * motion.position().norm() + 0.1 * std::abs(motion.theta);
  made.deviation = Eigen::Vector3d{m * m, m * m, rad * rad}.asDiagonal();
  made.kept.setZero();
  return made;
}

class SlamInTheHall : public testing::Test {
 protected:
  /// Answers by how far the wheels alone would be off at the end.
  double drive(const std::vector<Pose2>& way, double max_range_m = 20.0) {
    slam.begin_drive();
    const std::vector<TrackedScan> scans = test::surveyed(hall, way, random, max_range_m);
    for (std::size_t i = 0; i < scans.size(); ++i) {
      slam.observe(moved(scans, i));
      if (truth.size() < slam.survey().keyframes.size()) truth.push_back(way[i]);
    }
    return distance_between(way.front() * scans.back().odom_from_robot, way.back());
  }

  OccupancyGrid hall = test::drawn_hall(0.02);
  Random random{9};
  Slam slam;
  std::vector<Pose2> truth;
};

TEST_F(SlamInTheHall, IsWhereTheRobotWasThoughItsWheelsAreMetresOff) {
  EXPECT_GT(drive(test::rounds_of_the_hall(2), 8.0), 5.0);
  ASSERT_TRUE(slam.finish());
  EXPECT_GT(slam.survey().keyframes.size(), 250U);
  EXPECT_GT(slam.matched() + 5, slam.survey().keyframes.size());
  EXPECT_LT(farthest_off_m(slam, truth), 0.10);
}

TEST_F(SlamInTheHall, KeepsAScanEveryQuarterOfAMetreAndPassesOverAStandingRobot) {
  std::vector<Pose2> way(50, {1.5, 7.0, 0.0});
  for (int i = 1; i <= 100; ++i) way.push_back({1.5 + 0.05 * i, 7.0, 0.0});
  (void)drive(way);
  EXPECT_NEAR(static_cast<double>(slam.survey().keyframes.size()), 21.0, 2.0);
}

TEST_F(SlamInTheHall, JoinsADriveThatBeganElsewhere) {
  (void)drive(test::rounds_of_the_hall(1));
  (void)drive(test::way_along({{18.7, 6.8}, {2.0, 6.8}, {1.6, 1.4}, {12.0, 1.4}}));
  ASSERT_TRUE(slam.finish());
  ASSERT_TRUE(slam.is_joined(1));
  EXPECT_LT(farthest_off_m(slam, truth), 0.10);
}

TEST_F(SlamInTheHall, DoesNotJoinADriveThroughAnotherBuilding) {
  (void)drive(test::rounds_of_the_hall(1));
  OccupancyGrid other{{500, 500, 0.05, {0.0, 0.0}}, CellState::kFree};
  for (double x = 1.0; x < 24.0; x += 3.1) test::fill(other, {x, 3.0}, {x + 0.4, 3.4}, CellState::kOccupied);
  for (double y = 1.0; y < 24.0; y += 4.3) test::fill(other, {20.0, y}, {20.3, y + 2.0}, CellState::kOccupied);
  hall = other;
  (void)drive(test::way_along({{2.0, 5.0}, {18.0, 5.0}, {18.0, 20.0}}));
  ASSERT_TRUE(slam.finish());
  EXPECT_TRUE(slam.is_joined(0));
  EXPECT_FALSE(slam.is_joined(1));
}

TEST_F(SlamInTheHall, WidensAWindowThatIsHitAtItsRim) {
  const std::vector<Pose2> way = test::way_along({{1.5, 7.0}, {16.0, 7.0}});
  std::vector<TrackedScan> scans = test::surveyed(hall, way, random);
  const std::size_t middle = scans.size() / 2;
  const Pose2 pushed = scans[middle].odom_from_robot * Pose2{-0.2, 0.25, 0.15} * inverse(scans[middle].odom_from_robot);
  for (std::size_t i = middle; i < scans.size(); ++i) scans[i].odom_from_robot = pushed * scans[i].odom_from_robot;
  slam.begin_drive();
  for (std::size_t i = 0; i < scans.size(); ++i) {
    slam.observe(moved(scans, i));
    if (truth.size() < slam.survey().keyframes.size()) truth.push_back(way[i]);
  }
  ASSERT_TRUE(slam.finish());
  EXPECT_LT(farthest_off_m(slam, truth), 0.15);
}

TEST_F(SlamInTheHall, HasNothingToSayOfNothing) {
  ASSERT_TRUE(slam.finish());
  EXPECT_TRUE(slam.survey().keyframes.empty());
  slam.begin_drive();
  slam.begin_drive();
  (void)drive({{1.5, 7.0, 0.0}});
  ASSERT_TRUE(slam.finish());
  EXPECT_EQ(slam.survey().keyframes.size(), 1U);
}

TEST_F(SlamInTheHall, PassesOverADriveOfWhichNothingWasSeen) {
  slam.begin_drive();
  slam.begin_drive();
  (void)drive(test::rounds_of_the_hall(1));
  ASSERT_TRUE(slam.finish());
  EXPECT_EQ(slam.survey().component.size(), 1U);
  EXPECT_LT(farthest_off_m(slam, truth), 0.10);
}

}  // namespace
}  // namespace deltamap::surveying::slam
