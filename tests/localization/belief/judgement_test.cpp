// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/judgement.hpp"

#include <gtest/gtest.h>

#include "localization/motion/deskew.hpp"
#include "tests/localization/belief/aisle_drive.hpp"
#include "tests/support/scans/cast_scan.hpp"
#include "tests/support/worlds/drawn_flat.hpp"

namespace deltamap::localization::belief {
namespace {

/// A hypothesis is believed, and none beside it is followed.
hypotheses::HypothesisReport believed_with(double own_share) {
  hypotheses::HypothesisReport report;
  report.own_known = true;
  report.own_share = own_share;
  report.followed = 1;
  return report;
}

/// The same, with one beside it.
hypotheses::HypothesisReport believed_beside(double other_share) {
  hypotheses::HypothesisReport report = believed_with(1.0 - other_share);
  report.others[0].share = other_share;
  report.listed = 1;
  report.followed = 2;
  return report;
}

/// The same with none beside it, but for one that had this share if the robot had been carried there.
hypotheses::HypothesisReport believed_if_not_kidnapped(double share) {
  hypotheses::HypothesisReport report = believed_with(1.0);
  report.kidnapped_share = share;
  report.map_from_kidnapped = {15.0, 0.0, 0.0};
  return report;
}

OccupancyGrid an_empty_map() { return OccupancyGrid{GridGeometry{20, 20, 0.1, {0.0, 0.0}}, CellState::kFree}; }

/// A new view, while tracking.
void see(Judgement& judgement, const OccupancyGrid& map, const Scan& scan, const sensor::RefinedPose& believed,
         const hypotheses::HypothesisReport& hypotheses) {
  judgement.observe({.map = map,
                     .scan = scan,
                     .rays = motion::deskewed(scan, {}),
                     .believed = believed,
                     .state = LocalizerState::kTracking,
                     .passed = {.driven_m = 1.0},
                     .hypotheses = hypotheses});
}

/// The same by a scan without beams.
void see_nothing(Judgement& judgement, const hypotheses::HypothesisReport& hypotheses, Timestamp time) {
  Scan scan;
  scan.time = time;
  see(judgement, an_empty_map(), scan, {}, hypotheses);
}

/// Each scan follows from the one before, for so long that the robot has not been carried.
void follow_for_two_minutes(Judgement& judgement, AisleDrive& robot) {
  robot.speed_m_per_s = 0.05;
  for (int i = 0; i < 1250; ++i) judgement.follow(robot.next(), true);
}

/// Seen by a scan without beams, at a believed pose that has no other hypothesis beside it.
Judgement judged_with(const hypotheses::HypothesisReport& hypotheses, double pose_right = 0.9) {
  Judgement judgement{an_empty_map(), {}};
  judgement.start(pose_right);
  see_nothing(judgement, hypotheses, {});
  return judgement;
}

TEST(Judgement, HearsOfAnAliasThatTheRobotMayHaveBeenCarriedTo) {
  const Judgement judgement = judged_with(believed_if_not_kidnapped(0.9));
  EXPECT_DOUBLE_EQ(judgement.belief().other_share, 0.9);
  EXPECT_DOUBLE_EQ(judgement.belief().map_from_other.x, 15.0);
}

TEST(Judgement, HearsLessOfAnAliasWhereScansHaveFollowedEachOther) {
  Judgement judgement = judged_with(believed_with(1.0));
  AisleDrive robot;
  follow_for_two_minutes(judgement, robot);
  see_nothing(judgement, believed_if_not_kidnapped(0.9), robot.now());
  EXPECT_NEAR(judgement.belief().other_share, 0.09 / 0.19, 1e-9);
  EXPECT_DOUBLE_EQ(judgement.belief().map_from_other.x, 15.0);
  see_nothing(judgement, believed_if_not_kidnapped(0.3), robot.now());
  EXPECT_LT(judgement.belief().other_share, 0.05);
  judgement.fix_by_surfaces(true);
  EXPECT_FALSE(judgement.is_held()) << "somebody may have chosen the place";
  robot.carried_m = 2.5;
  for (int i = 0; i < 10; ++i) judgement.follow(robot.next(), true);
  see_nothing(judgement, believed_if_not_kidnapped(0.3), robot.now());
  EXPECT_DOUBLE_EQ(judgement.belief().other_share, 0.3) << "a scan has broken off";
}

/// Walls that have proven to stay.
StabilityRecord lived_in(const OccupancyGrid& map) {
  Stability stability{map.geometry()};
  for (int visit = 0; visit < 20; ++visit) {
    const Point2 seen_from{visit % 2 == 0 ? 2.0 : 6.0, 1.6};
    for (int row = 0; row < map.geometry().height; ++row) {
      for (int column = 0; column < map.geometry().width; ++column) {
        if (map.at({column, row}) != CellState::kOccupied) continue;
        stability.confirm({column, row}, seen_from, timestamp_from_ns(visit * 30'000'000'000));
      }
    }
  }
  return stability.record();
}

/// A robot in a flat whose walls have proven to stay.
class JudgementInAFlat : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(judgement.restore(lived_in(map)));
    judgement.start(0.9);
  }

  /// A new view from a pose, which is believed to be `believed`.
  void see_from(const Pose2& map_from_robot, const hypotheses::HypothesisReport& hypotheses) {
    see(judgement, map, test::cast_scan(map, map_from_robot, robot.now(), {}, random), believed, hypotheses);
  }

  const OccupancyGrid map = test::drawn_flat();
  const sensor::RefinedPose believed{{4.0, 1.6, 0.1}, Eigen::Vector3d{1e-4, 1e-4, 1e-5}.asDiagonal()};
  Judgement judgement{map, {}};
  AisleDrive robot;
  Random random{3};
};

TEST_F(JudgementInAFlat, CallsNoPoseRightThatSomebodyMayHaveCarriedTheRobotFrom) {
  follow_for_two_minutes(judgement, robot);
  for (const double if_kidnapped : {0.0, 0.3, 0.0}) {
    see_from(believed.map_from_robot, believed_if_not_kidnapped(if_kidnapped));
    for (const bool fixed : {false, true}) {
      judgement.fix_by_surfaces(fixed);
      const Belief belief = judgement.belief();
      EXPECT_GT(belief.pose_right, kSurelyRight) << if_kidnapped;
      EXPECT_EQ(belief.verdict, if_kidnapped > 0.1 ? PoseVerdict::kUndecided : PoseVerdict::kRight) << if_kidnapped;
    }
  }
}

TEST_F(JudgementInAFlat, IsAsRightAsWrongFromTheScanOnThatTellsOfAKidnapping) {
  for (int i = 0; i < 150; ++i) {
    judgement.follow(robot.next(), true);
    see_from(believed.map_from_robot, believed_with(1.0));
  }
  ASSERT_EQ(judgement.belief().verdict, PoseVerdict::kRight);
  robot.carried_m = 2.5;
  judgement.follow(robot.next(), true);
  for (int i = 0; i < 50 && !judgement.belief().fits_worse; ++i) {
    see_from({6.0, 2.0, 2.0}, believed_with(1.0));
    judgement.follow(robot.next(), true);
  }
  ASSERT_TRUE(judgement.belief().fits_worse);
  EXPECT_DOUBLE_EQ(judgement.belief().pose_right, kAsRightAsWrong) << "before it is held against the map again";
  EXPECT_EQ(judgement.belief().verdict, PoseVerdict::kUndecided);
}

TEST(Judgement, HearsOfNoPlaceWhereNoneIsKnown) {
  EXPECT_DOUBLE_EQ(judged_with(believed_with(1.0)).belief().other_share, 0.0);
}

TEST(Judgement, BelievesAPoseThatSurfacesFixAsFarAsNoOtherSpeaksAgainstIt) {
  Judgement judgement = judged_with(believed_beside(0.2), 0.05);
  EXPECT_NE(judgement.belief().verdict, PoseVerdict::kRight);
  EXPECT_LT(judgement.trust(), 0.1);
  judgement.fix_by_surfaces(true);
  EXPECT_EQ(judgement.belief().verdict, PoseVerdict::kUndecided) << "an alias is too probable";
  EXPECT_FALSE(judgement.is_held());
  EXPECT_DOUBLE_EQ(judgement.belief().pose_right, 0.8);
  EXPECT_DOUBLE_EQ(judgement.trust(), 0.5);
}

TEST(Judgement, BelievesAPoseThatSurfacesFixNoMoreThanTilesMaySayThatHaveNotBeenProven) {
  Judgement judgement = judged_with(believed_with(1.0), 0.05);
  judgement.fix_by_surfaces(true);
  EXPECT_EQ(judgement.belief().verdict, PoseVerdict::kUndecided);
  EXPECT_DOUBLE_EQ(judgement.belief().pose_right, PoseVerdictParams{}.unproven_limit);
  EXPECT_TRUE(judgement.is_held());
}

/// Where things have been moved together, the pose that follows them fits best: it takes the belief, not the pose.
TEST(Judgement, CallsAPoseThatSurfacesFixNotRightWhereAnotherIsRatherRightAndKeepsIt) {
  Judgement judgement = judged_with(believed_beside(0.6), 0.05);
  const Scan scan;
  judgement.follow({.scan = scan, .rays = {}, .odom_from_robot = {}, .map_from_robot = {}}, true);
  judgement.fix_by_surfaces(true);
  EXPECT_TRUE(judgement.is_fixed());
  EXPECT_FALSE(judgement.is_held());
  EXPECT_DOUBLE_EQ(judgement.trust(), 0.5);
  EXPECT_DOUBLE_EQ(judgement.belief().pose_right, 0.4);
  EXPECT_EQ(judgement.belief().verdict, PoseVerdict::kUndecided);
}

TEST(Judgement, GivesAPoseNoMoreBeliefThanAnotherLeavesIt) {
  hypotheses::HypothesisReport report = believed_beside(0.7);
  report.own_share = 1.0;
  EXPECT_DOUBLE_EQ(judged_with(report, 0.99).belief().pose_right, 0.3);
}

TEST(Judgement, ForgetsAtAStartThatSurfacesHaveFixedThePose) {
  Judgement judgement = judged_with({});
  judgement.fix_by_surfaces(true);
  judgement.start(0.5);
  EXPECT_NE(judgement.belief().verdict, PoseVerdict::kRight);
}

}  // namespace
}  // namespace deltamap::localization::belief
