// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/judgement.hpp"

#include <gtest/gtest.h>

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

/// Seen by a scan without beams, at a believed pose that has no other hypothesis beside it.
Judgement judged_with(const hypotheses::HypothesisReport& hypotheses, double pose_right = 0.9) {
  const OccupancyGrid map{GridGeometry{20, 20, 0.1, {0.0, 0.0}}, CellState::kFree};
  Judgement judgement{map, {}};
  judgement.start(pose_right);
  const Scan scan;
  const sensor::RefinedPose believed{};
  judgement.observe({.map = map,
                     .scan = scan,
                     .rays = {},
                     .believed = believed,
                     .state = LocalizerState::kTracking,
                     .passed = {},
                     .hypotheses = hypotheses});
  return judgement;
}

TEST(Judgement, HearsOfAWatchedPlaceBesideWhichNoneIsFollowed) {
  hypotheses::HypothesisReport report = believed_with(1.0);
  report.kidnapped_share = 0.4;
  report.map_from_kidnapped = {15.0, 0.0, 0.0};
  const Belief belief = judged_with(report).belief();
  EXPECT_DOUBLE_EQ(belief.other_share, 0.4);
  EXPECT_DOUBLE_EQ(belief.map_from_other.x, 15.0);
}

TEST(Judgement, HearsOfNoPlaceWhereNoneIsKnown) {
  EXPECT_DOUBLE_EQ(judged_with(believed_with(1.0)).belief().other_share, 0.0);
}

TEST(Judgement, BelievesAPoseThatSurfacesFixAsFarAsNoOtherSpeaksAgainstIt) {
  hypotheses::HypothesisReport report = believed_with(0.8);
  report.kidnapped_share = 0.2;
  Judgement judgement = judged_with(report, 0.05);
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
  hypotheses::HypothesisReport report = believed_with(1.0);
  report.kidnapped_share = 0.6;
  Judgement judgement = judged_with(report, 0.05);
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
  hypotheses::HypothesisReport report = believed_with(1.0);
  report.kidnapped_share = 0.7;
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
