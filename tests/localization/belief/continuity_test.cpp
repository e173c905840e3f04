// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/continuity.hpp"

#include <gtest/gtest.h>

#include "tests/localization/belief/aisle_drive.hpp"

namespace deltamap::localization::belief {
namespace {

/// Of 100 beams that the map expects to end somewhere.
Belief fitting(std::uint32_t fit, std::uint32_t short_of, PoseVerdict verdict = PoseVerdict::kUndecided) {
  Belief belief;
  belief.elsewhere = {.expected = 100, .fit = fit, .short_of = short_of, .beyond = 100 - fit - short_of};
  belief.verdict = verdict;
  return belief;
}

/// A tracked pose in a map that is out of date anyway: a bad fit alone says nothing.
class FollowedPose : public testing::Test {
 protected:
  void SetUp() override { see(fitting(80, 10), 200); }

  void see(const Belief& by_beams, int scans, int thing_beams = 0) {
    for (int i = 0; i < scans; ++i) {
      told += continuity.observe(robot.next(thing_beams), by_beams, is_tracking) ? 1 : 0;
      has_broken = has_broken || !continuity.is_unbroken();
    }
  }

  AisleDrive robot;
  Continuity continuity{{}};
  bool is_tracking = true;
  bool has_broken = false;
  int told = 0;  ///< so often that the robot was carried
};

TEST_F(FollowedPose, IsUnbrokenWhereAThingComes) {
  see(fitting(50, 40), 100, 45);
  EXPECT_FALSE(has_broken);
}

TEST_F(FollowedPose, MayHaveBeenCarriedUntilScansHaveFollowedForTwoMinutes) {
  robot.speed_m_per_s = 0.05;
  EXPECT_TRUE(continuity.may_have_been_kidnapped()) << "20 s after the start";
  see(fitting(80, 10), 1050);
  EXPECT_FALSE(continuity.may_have_been_kidnapped());
  robot.carried_m = 2.5;
  see(fitting(80, 10), 1150);
  EXPECT_TRUE(continuity.may_have_been_kidnapped());
  robot.set_back(3600.0);
  see(fitting(80, 10), 100);
  EXPECT_FALSE(continuity.may_have_been_kidnapped());
}

TEST_F(FollowedPose, MayHaveBeenCarriedWhereNoScanTells) {
  robot.speed_m_per_s = 0.05;
  see(fitting(80, 10), 1050);
  robot.epoch = 1;
  see(fitting(80, 10), 1);
  EXPECT_TRUE(continuity.may_have_been_kidnapped()) << "odometry began anew";
  see(fitting(80, 10), 1250);
  EXPECT_FALSE(continuity.may_have_been_kidnapped());
  is_tracking = false;
  see(fitting(80, 10), 1);
  EXPECT_TRUE(continuity.may_have_been_kidnapped()) << "no pose is tracked";
  is_tracking = true;
  see(fitting(80, 10), 1250);
  continuity.start();
  EXPECT_TRUE(continuity.may_have_been_kidnapped()) << "another pose is believed";
}

TEST_F(FollowedPose, IsUnbrokenInAHallThatIsMoreAndMoreOutOfDate) {
  see(fitting(30, 10), 100);
  EXPECT_FALSE(has_broken);
}

TEST_F(FollowedPose, IsUnbrokenWhereScansBreakOffAndTheMapFitsAsBefore) {
  EXPECT_FALSE(continuity.broke_off_at());
  robot.carried_m = 2.5;
  see(fitting(80, 10), 1);
  EXPECT_EQ(continuity.broke_off_at(), robot.now());
  see(fitting(80, 10), 100);
  EXPECT_LT(continuity.broke_off_at(), robot.now());
  EXPECT_FALSE(continuity.fits_worse());
  EXPECT_FALSE(has_broken);
}

TEST_F(FollowedPose, IsBrokenByAWorseFitSoonAfterABreak) {
  robot.carried_m = 2.5;
  see(fitting(80, 10), 30);
  EXPECT_FALSE(has_broken);
  see(fitting(30, 10), 15);
  EXPECT_TRUE(continuity.fits_worse());
  EXPECT_FALSE(continuity.is_unbroken());
  EXPECT_EQ(told, 1);
}

TEST_F(FollowedPose, IsUnbrokenByAWorseFitLongAfterABreak) {
  robot.carried_m = 2.5;
  see(fitting(80, 10), 70);
  see(fitting(30, 10), 50);
  EXPECT_FALSE(has_broken);
}

TEST_F(FollowedPose, IsUnbrokenByABreakWhileNoPoseIsTracked) {
  is_tracking = false;
  robot.carried_m = 2.5;
  see(fitting(30, 10), 50);
  EXPECT_FALSE(has_broken);
}

TEST_F(FollowedPose, IsUnbrokenAgainWhereItIsFoundRightAndAsMuchFitsAsBefore) {
  robot.carried_m = 2.5;
  see(fitting(30, 10), 50);
  see(fitting(30, 10, PoseVerdict::kRight), 50);
  EXPECT_FALSE(continuity.is_unbroken()) << "it may be an alias";
  see(fitting(80, 10), 50);
  EXPECT_FALSE(continuity.is_unbroken()) << "nothing says that it is right";
  see(fitting(80, 10, PoseVerdict::kRight), 1);
  EXPECT_TRUE(continuity.is_unbroken());
}

TEST_F(FollowedPose, NeedNotFitAsBeforeTwoMinutesAfterABreakWhateverBreaksOffMeanwhile) {
  robot.carried_m = 2.5;
  see(fitting(30, 10, PoseVerdict::kRight), 600);
  robot.carried_m = 5.0;
  see(fitting(30, 10, PoseVerdict::kRight), 550);
  EXPECT_TRUE(continuity.fits_worse());
  EXPECT_FALSE(continuity.is_unbroken());
  see(fitting(30, 10, PoseVerdict::kRight), 100);
  EXPECT_FALSE(continuity.fits_worse());
  EXPECT_TRUE(continuity.is_unbroken());
}

TEST_F(FollowedPose, IsNotBrokenByAnotherHypothesisAlone) {
  Belief belief = fitting(80, 10);
  for (const double share : {0.4, 0.6, 0.99}) {
    belief.other_share = share;
    see(belief, 10);
    EXPECT_TRUE(continuity.is_unbroken()) << share;
  }
  robot.carried_m = 2.5;
  see(fitting(30, 10), 50);
  EXPECT_FALSE(continuity.is_unbroken()) << "a robot that was carried";
}

TEST_F(FollowedPose, IsUnbrokenWhereAnotherPoseIsBelieved) {
  robot.carried_m = 2.5;
  see(fitting(30, 10), 50);
  EXPECT_FALSE(continuity.is_unbroken());
  continuity.start();
  see(fitting(80, 10), 50);
  EXPECT_TRUE(continuity.is_unbroken());
  see(fitting(30, 10), 10);
  EXPECT_FALSE(continuity.is_unbroken()) << "as much has to fit there as before";
}

TEST_F(FollowedPose, OnceDoubtedForAnotherIsNotCalledCarriedByAWorseFitLongAfterABreak) {
  Belief belief = fitting(80, 10);
  belief.other_share = 0.6;
  see(belief, 1);
  robot.carried_m = 2.5;
  see(fitting(80, 10), 70);
  see(fitting(30, 10), 50);
  EXPECT_FALSE(continuity.fits_worse());
}

TEST_F(FollowedPose, IsNotCalledCarriedForeverWhereTheClockFallsBack) {
  robot.carried_m = 2.5;
  see(fitting(30, 10), 50);
  EXPECT_TRUE(continuity.fits_worse());
  robot.set_back(3600.0);
  see(fitting(30, 10), 1);
  EXPECT_FALSE(continuity.fits_worse());
}

}  // namespace
}  // namespace deltamap::localization::belief
