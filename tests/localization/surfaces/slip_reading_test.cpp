// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/slip_reading.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/localization/surfaces/surroundings.hpp"

namespace deltamap::localization::surfaces::slip_test {
namespace {

TEST(SlipReading, LeavesAContainerThatWasMovedWhereItWasLastSeen) {
  const Pose2 truth{0.0, 0.0, 0.08};
  Surroundings around = aisle_from(truth);
  around.keep_in_view(kAhead, 0.35, truth);
  const SlipReading::Answer answer = around.best_near({0.3, 0.0, 0.1}, SlipTime::kNow, kSlip);
  EXPECT_NEAR(answer.pose.x, truth.x, 0.02);
  EXPECT_NEAR(answer.pose.theta, truth.theta, 0.005);
  EXPECT_TRUE(answer.read_wrong.empty());
  EXPECT_GT(around.gain({0.3, 0.0, 0.1}, SlipTime::kNow), 10.0);
}

TEST(SlipReading, AsksNothingThatWasSeenBeforeASlipJustNow) {
  Surroundings around;
  (void)around.follow(kAhead, 0.35, 4.0);
  EXPECT_LE(around.gain({0.35, 0.0, 0.0}, SlipTime::kNow), 0.0);
}

TEST(SlipReading, UndoesAMoveByASlipThatLiesBehind) {
  Surroundings around;
  const std::size_t moved = around.follow(kAhead, 0.35, 4.0);
  const std::size_t seen_before = around.follow(facing({-1.0, 0.0}, {5.0, 4.0}), 0.0, 6.0);
  const Pose2 where_it_holds{0.35, 0.0, 0.0};
  EXPECT_GT(around.gain(where_it_holds, SlipTime::kBehind), 3.0);
  const std::vector<std::size_t> wrong = around.best_near(where_it_holds, SlipTime::kBehind, kSlip).read_wrong;
  EXPECT_EQ(wrong, std::vector{moved});
  EXPECT_EQ(std::find(wrong.begin(), wrong.end(), seen_before), wrong.end());
}

TEST(SlipReading, HoldsASlipThatLiesBehindAgainstAllThatWasSeenSince) {
  Surroundings around;
  (void)around.follow(kAhead, 0.35, 4.0);
  (void)around.follow(facing({-1.0, 0.0}, {5.0, 4.0}), 0.0, 3.0);
  (void)around.follow(facing({1.0, 0.0}, {-3.0, 2.0}), 0.0, 2.0);
  EXPECT_LE(around.gain({0.35, 0.0, 0.0}, SlipTime::kBehind), 0.0);
}

TEST(SlipReading, GivesASurfaceThatIsSeenForTheFirstTimeTheWeightOfTheMap) {
  const Pose2 turned{0.0, 0.0, 0.08};
  const Surroundings known = aisle_from(turned);
  Surroundings with_a_new_one = aisle_from(turned);
  // Where the map has it, had the robot not turned.
  with_a_new_one.show(kAhead, 0.0, {}, SurfaceRecord::kNotFollowed);
  const double lost = known.gain(turned, SlipTime::kNow) - with_a_new_one.gain(turned, SlipTime::kNow);
  EXPECT_GT(lost, 0.0);
  EXPECT_LT(lost, 7.0);  // one that was in view just before would say 12
}

TEST(SlipReading, ExpectsASurfaceWhereItStoodAtTheLastVisit) {
  const Pose2 truth{0.1, 0.0, 0.0};
  Surroundings around;
  around.show(kAhead, 0.35, truth, SurfaceRecord::kNotFollowed);
  around.remember(0.35);
  EXPECT_NEAR(around.best_near({0.0, 0.0, 0.0}, SlipTime::kNow, kSlip).pose.x, truth.x, 0.01);
}

}  // namespace
}  // namespace deltamap::localization::surfaces::slip_test
