// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/pose_verdict.hpp"

#include <gtest/gtest.h>

namespace deltamap::localization::belief {
namespace {

/// 40 beams across a corridor, 20 along it; so many of each fit, the others go through.
ViewTally view_of(double fit_across, double fit_along, bool stable = true) {
  ViewTally view;
  const std::array<Support, 2> along{Support{40.0 * fit_across, 0.0, 40.0 * (1.0 - fit_across)},
                                     Support{20.0 * fit_along, 0.0, 20.0 * (1.0 - fit_along)}};
  (stable ? view.stable_along : view.elsewhere_along) = along;
  BeamCounts& counts = stable ? view.stable : view.elsewhere;
  counts.expected = 60;
  counts.fit = static_cast<std::uint32_t>(along[0].fit + along[1].fit);
  counts.beyond = counts.expected - counts.fit;
  return view;
}

/// A robot at 0.5 m/s, its beams checked every 0.2 s.
const Belief& after(PoseJudge& judge, double duration_s, const ViewTally& view, double speed_m_per_s = 0.5,
                    const PoseJudge::Shares& shares = {}) {
  for (double t = 0.0; t < duration_s; t += 0.2) judge.observe(view, {0.2 * speed_m_per_s, 0.0, 0.2}, shares);
  return judge.belief();
}

PoseJudge sure() {
  PoseJudge judge{{}};
  judge.start(0.9);
  (void)after(judge, 20.0, view_of(1.0, 1.0));
  return judge;
}

TEST(PoseVerdict, IsRightWhereProvenTilesHoldThePoseBothWays) {
  PoseJudge judge = sure();
  EXPECT_EQ(judge.belief().verdict, PoseVerdict::kRight);
  EXPECT_GT(judge.belief().pose_right, 0.99);
  EXPECT_LT(judge.belief().map_wrong, 0.15);
}

TEST(PoseVerdict, StaysRightWhereHalfOfTheHallHasChangedAndBlamesTheMap) {
  PoseJudge judge = sure();
  const Belief& belief = after(judge, 120.0, view_of(0.6, 0.5));
  EXPECT_EQ(belief.verdict, PoseVerdict::kRight);
  EXPECT_GT(belief.map_wrong, 0.9);
}

TEST(PoseVerdict, BlamesTheMapWhereSurfacesFixAPoseThatFewBeamsSupport) {
  PoseJudge judge{{}};
  judge.start(0.9);
  const Belief by_beams = after(judge, 60.0, view_of(0.1, 0.1, false));
  const Belief fixed = judge.belief_if_fixed();
  EXPECT_LT(by_beams.pose_right, 0.2);
  EXPECT_DOUBLE_EQ(fixed.pose_right, judge.limit());
  EXPECT_NEAR(by_beams.map_wrong, 0.5, 0.1) << "the pose may be wrong, and then nothing is known of the map";
  EXPECT_GT(fixed.map_wrong, 0.9);
}

TEST(PoseVerdict, IsNotTakenInByACorridorsWalls) {
  PoseJudge judge = sure();
  EXPECT_NE(after(judge, 3.0, view_of(1.0, 0.05)).verdict, PoseVerdict::kRight) << "within five seconds";
  EXPECT_EQ(after(judge, 5.0, view_of(1.0, 0.05)).verdict, PoseVerdict::kWrong);
}

TEST(PoseVerdict, NoticesAKidnappingWhileItStands) {
  PoseJudge judge = sure();
  EXPECT_NE(after(judge, 20.0, view_of(0.1, 0.0), 0.0).verdict, PoseVerdict::kRight);
}

TEST(PoseVerdict, GrowsNoMoreCertainByStandingStillThanByDriving) {
  PoseJudge standing{{}};
  PoseJudge driving{{}};
  standing.start(0.5);
  driving.start(0.5);
  EXPECT_LT(after(standing, 4.0, view_of(0.8, 0.8), 0.0).pose_right, after(driving, 4.0, view_of(0.8, 0.8)).pose_right);
}

TEST(PoseVerdict, IsLimitedWhereNoProvenTilesHaveToldOfThePoseLately) {
  PoseJudge judge = sure();
  EXPECT_DOUBLE_EQ(judge.limit(), 1.0);
  (void)after(judge, 120.0, view_of(1.0, 1.0, false));
  EXPECT_NEAR(judge.limit(), PoseVerdictParams{}.unproven_limit, 1e-3);
  judge.start(0.9);
  EXPECT_DOUBLE_EQ(judge.limit(), PoseVerdictParams{}.unproven_limit);
}

TEST(PoseVerdict, IsUndecidedWhereNothingHasProvenStable) {
  PoseJudge judge{{}};
  judge.start(0.9);
  EXPECT_EQ(after(judge, 60.0, view_of(1.0, 1.0, false)).verdict, PoseVerdict::kUndecided);
  EXPECT_GT(judge.trust(), 0.95) << "enough to earn stability by";
}

TEST(PoseVerdict, IsUndecidedWhereAnotherPlaceFitsAsWell) {
  PoseJudge judge = sure();
  const Belief& belief = after(judge, 10.0, view_of(1.0, 1.0), 0.5,
                               {.believed = 0.5, .best_other = 0.5, .map_from_other = {30.0, 30.0, 0.0}});
  EXPECT_EQ(belief.verdict, PoseVerdict::kUndecided);
  EXPECT_EQ(belief.other_share, 0.5);
  EXPECT_EQ(belief.map_from_other, (Pose2{30.0, 30.0, 0.0}));
}

TEST(PoseVerdict, IsUndecidedWhereARobotThatWasCarriedWouldSeeTheSame) {
  PoseJudge judge = sure();
  const Belief& belief = after(judge, 10.0, view_of(1.0, 1.0), 0.5, {.best_other = 0.01, .if_kidnapped = 0.5});
  EXPECT_EQ(belief.verdict, PoseVerdict::kUndecided);
  EXPECT_GT(belief.pose_right, 0.95) << "robots are seldom carried unseen";
  judge.start(0.99);
  EXPECT_TRUE(judge.is_surely_right(0.99)) << "forgotten";
}

TEST(PoseVerdict, IsWrongWhereAnotherPlaceHasWon) {
  PoseJudge judge = sure();
  EXPECT_EQ(after(judge, 1.0, view_of(0.7, 0.6), 0.5, {.believed = 0.02, .best_other = 0.98}).verdict,
            PoseVerdict::kWrong);
}

TEST(PoseVerdict, IsUndecidedWhileNoPlaceIsBelieved) {
  PoseJudge judge = sure();
  EXPECT_EQ(after(judge, 10.0, view_of(1.0, 1.0), 0.5, {.searching = true}).verdict, PoseVerdict::kUndecided);
}

TEST(PoseVerdict, IsNotShakenByPeopleWhoStandInTheWay) {
  PoseJudge judge = sure();
  ViewTally view = view_of(1.0, 1.0);
  for (Support& along : view.stable_along) {
    along.short_of = 0.4 * along.fit;
    along.fit *= 0.6;
  }
  EXPECT_EQ(after(judge, 60.0, view).verdict, PoseVerdict::kRight);
}

TEST(PoseVerdict, TrustsAPoseAgainAsSoonAsTheOtherPlaceIsRefuted) {
  PoseJudge judge = sure();
  EXPECT_LT(after(judge, 2.0, view_of(1.0, 1.0), 0.5, {.believed = 0.1, .best_other = 0.9}).pose_right, 0.2);
  EXPECT_GT(after(judge, 0.2, view_of(1.0, 1.0)).pose_right, 0.95);
}

TEST(PoseVerdict, SaysNothingNewWithoutBeams) {
  PoseJudge judge{{}};
  judge.start(0.5);
  const Belief& belief = after(judge, 10.0, {});
  EXPECT_NEAR(belief.pose_right, 0.5, 0.05);
  EXPECT_EQ(belief.verdict, PoseVerdict::kUndecided);
}

}  // namespace
}  // namespace deltamap::localization::belief
