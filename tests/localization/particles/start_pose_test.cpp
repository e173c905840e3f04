// SPDX-License-Identifier: Apache-2.0
#include "localization/particles/start_pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::localization::particles {
namespace {

constexpr double kCellM = 0.25;
const OccupancyGrid kRoom = test::drawn_grid(
    {
        "                ",  //
        "  ############  ",  //
        "  #..........#  ",  //
        "  #....###...#  ",  //
        "  #....###...#  ",  //
        "  #....###...#  ",  //
        "  #..........#  ",  //
        "  ############  ",  //
        "                ",  //
    },
    kCellM);

TEST(UsableStart, BelievesAPoseInFreeSpaceThatAPersonGaveAndChecksARememberedOne) {
  const InitialPose given{{1.0, 1.0, 0.3}, 0.2, 0.1};
  EXPECT_EQ(usable_start(kRoom, given).kind, StartKind::kBelieve);
  EXPECT_EQ(usable_start(kRoom, given).pose.map_from_robot, given.map_from_robot);
  InitialPose remembered = given;
  remembered.remembered = true;
  EXPECT_EQ(usable_start(kRoom, remembered).kind, StartKind::kCheck);
  EXPECT_EQ(usable_start(kRoom, remembered).pose.map_from_robot, given.map_from_robot);
}

TEST(UsableStart, MovesAPoseInAnObstacleToTheNearestFreeCellAndIsLessSureOfIt) {
  const Point2 in_the_block{2.1, 1.125};
  const Start start = usable_start(kRoom, {{in_the_block.x(), in_the_block.y(), 0.3}, 0.3, 0.1});
  const Point2 moved = start.pose.map_from_robot.position();
  EXPECT_EQ(start.kind, StartKind::kCheck);
  EXPECT_LT((moved - in_the_block).norm(), 0.5) << "just beside the block";
  EXPECT_EQ(kRoom.at(kRoom.geometry().cell_at(moved)), CellState::kFree);
  EXPECT_EQ(start.pose.map_from_robot.theta, 0.3);
  EXPECT_NEAR(start.pose.position_deviation_m, std::hypot(0.3, (moved - in_the_block).norm()), 1e-12);
}

TEST(UsableStart, LeavesAPoseInTheUnknownNearFreeSpaceWhereItIs) {
  const Start start = usable_start(kRoom, {{0.3, 1.0, 0.0}, 0.2, 0.1});
  EXPECT_EQ(start.kind, StartKind::kBelieve);
  EXPECT_EQ(start.pose.map_from_robot.x, 0.3);
}

TEST(UsableStart, IsAnywhereWhereNoFreeCellLiesWithinAMetre) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Pose2& nonsense : {Pose2{-1.0, 1.0, 0.0}, Pose2{1e300, 1.0, 0.0}, Pose2{1e8, 1.0, 0.0},
                                Pose2{1.0, nan, 0.0}, Pose2{1.0, 1.0, nan}}) {
    EXPECT_EQ(usable_start(kRoom, {nonsense}).kind, StartKind::kAnywhere) << nonsense.x << ' ' << nonsense.y;
  }
}

TEST(AnywhereIn, IsTheMiddleOfWhatTheMapShowsGiveOrTakeAllOfIt) {
  const ParticleCluster anywhere = anywhere_in(kRoom);
  EXPECT_NEAR(anywhere.map_from_robot.x, 2.0, 1e-12);
  EXPECT_NEAR(anywhere.map_from_robot.y, 1.125, 1e-12);
  EXPECT_NEAR(std::sqrt(3.0 * anywhere.covariance(0, 0)), 6.0 * kCellM, 1e-12);
  EXPECT_NEAR(std::sqrt(3.0 * anywhere.covariance(2, 2)), std::numbers::pi, 1e-12);
  EXPECT_EQ(anywhere.weight, 0.0);
}

TEST(WithFreeSpace, RefusesAMapInWhichNobodyCanBe) {
  const auto room = std::make_shared<const OccupancyGrid>(kRoom);
  EXPECT_EQ(with_free_space(room), room);
  EXPECT_THROW((void)with_free_space(nullptr), std::runtime_error);
  EXPECT_THROW((void)with_free_space(std::make_shared<const OccupancyGrid>(test::drawn_grid({"# "}))),
               std::runtime_error);
}

PoseCheck::Answer after(const std::vector<double>& fits) {
  PoseCheck check;
  check.start();
  PoseCheck::Answer answer{};
  for (const double fit : fits) {
    EXPECT_TRUE(check.under_way());
    answer = check.observe(fit, 0.5);
  }
  EXPECT_EQ(check.under_way(), answer == PoseCheck::Answer::kNotYet);
  return answer;
}

TEST(PoseCheck, DecidesByTheMeanFitOfFiveScans) {
  EXPECT_EQ(after({0.9, 0.9, 0.9, 0.9}), PoseCheck::Answer::kNotYet);
  EXPECT_EQ(after({0.9, 0.9, 0.9, 0.0, 0.0}), PoseCheck::Answer::kFits);
  EXPECT_EQ(after({0.6, 0.6, 0.6, 0.6, 0.0}), PoseCheck::Answer::kDoesNotFit);
}

TEST(PoseCheck, BeginsAnewAtEachStart) {
  PoseCheck check;
  EXPECT_FALSE(check.under_way());
  check.start();
  for (int i = 0; i < 4; ++i) (void)check.observe(1.0, 0.5);
  check.start();
  for (int i = 0; i < 4; ++i) EXPECT_EQ(check.observe(0.1, 0.5), PoseCheck::Answer::kNotYet);
  EXPECT_EQ(check.observe(0.1, 0.5), PoseCheck::Answer::kDoesNotFit);
  check.start();
  check.end();
  EXPECT_FALSE(check.under_way());
}

}  // namespace
}  // namespace deltamap::localization::particles
