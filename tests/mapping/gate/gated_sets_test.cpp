// SPDX-License-Identifier: Apache-2.0
// What becomes of the sets: handed on, refused, or ordered back.
#include "mapping/gate/gated_sets.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <variant>
#include <vector>

#include "tests/mapping/straight_drive.hpp"

namespace deltamap::mapping::gate {
namespace {

ScanSet set_of(double began_s, double ended_s, std::uint32_t phase = 1) {
  ScanSet set;
  set.phase = phase;
  set.began = StraightDrive::at(began_s);
  set.ended = StraightDrive::at(ended_s);
  return set;
}

class Sets : public testing::Test {
 protected:
  /// Drives on and returns what is handed on.
  std::vector<ScanSet> on(double duration_s) {
    std::vector<ScanSet> handed_on;
    for (double t = 0.0; t < duration_s - 1e-9; t += kPeriod_s) {
      TrackedScan tracked = robot.next();
      tracked.estimate.belief.other_share = other_share;
      take(tracked, handed_on);
    }
    return handed_on;
  }
  std::vector<ScanSet> lose_the_way() {
    TrackedScan tracked = robot.next();
    tracked.estimate.state = LocalizerState::kLost;
    std::vector<ScanSet> handed_on;
    take(tracked, handed_on);
    return handed_on;
  }
  void take(const TrackedScan& tracked, std::vector<ScanSet>& handed_on) {
    sets.observe(tracked);
    while (auto request = sets.next()) {
      if (const auto* order = std::get_if<WithdrawOrder>(&*request))
        ordered_back.push_back(*order);
      else if (std::holds_alternative<Settlement>(*request))
        settled_at_s.push_back(robot.time_s());
      else
        handed_on.push_back(std::get<ScanSet>(*std::move(request)));
    }
  }
  void end_set(double span_s, std::uint32_t phase) {
    sets.take(set_of(robot.time_s() - span_s, robot.time_s(), phase), robot.next());
  }

  StraightDrive robot;
  double other_share = 0.0;
  GatedSets sets{{}};
  std::vector<WithdrawOrder> ordered_back;
  std::vector<double> settled_at_s;
};

TEST_F(Sets, WaitAMomentAndAreHandedOn) {
  (void)on(10.0);
  end_set(5.0, 1);
  EXPECT_TRUE(on(1.0).empty());
  const auto handed_on = on(1.0);
  ASSERT_EQ(handed_on.size(), 1u);
  EXPECT_FALSE(handed_on[0].pose_in_doubt);
  EXPECT_GT(handed_on[0].covariance(0, 0), 0.0);
  EXPECT_FALSE(handed_on[0].settled) << "5 m: all is provisional";
}

TEST_F(Sets, WaitOnWhileAnotherPlaceIsConceivable) {
  (void)on(10.0);
  end_set(5.0, 1);
  other_share = 0.02;
  EXPECT_TRUE(on(10.0).empty());
  EXPECT_TRUE(sets.lets_vote()) << "so little does not shut the gate";
  other_share = 0.0;
  EXPECT_EQ(on(kPeriod_s).size(), 1u);
}

TEST_F(Sets, AreRefusedWhereThePoseProvesWrongWhileTheyWait) {
  (void)on(10.0);
  end_set(5.0, 1);
  const auto handed_on = lose_the_way();
  ASSERT_EQ(handed_on.size(), 1u) << "nothing was written: no order";
  EXPECT_TRUE(handed_on[0].pose_in_doubt);
}

TEST_F(Sets, AreRefusedWhereTheirVotesAreOlderThanTheTrustInThePose) {
  (void)on(10.0);
  (void)lose_the_way();
  (void)on(25.0);
  end_set(8.0, 1);
  end_set(1.0, 2);
  const auto handed_on = on(3.0);
  ASSERT_EQ(handed_on.size(), 2u);
  EXPECT_TRUE(handed_on[0].pose_in_doubt);
  EXPECT_FALSE(handed_on[1].pose_in_doubt);
}

TEST_F(Sets, WhatWasWrittenLatelyIsOrderedBackOnce) {
  (void)on(60.0);
  end_set(2.0, 1);
  ASSERT_EQ(on(5.0).size(), 1u);
  EXPECT_TRUE(lose_the_way().empty());
  ASSERT_EQ(ordered_back.size(), 1u);
  EXPECT_NEAR(seconds(robot.now() - ordered_back[0].from), 30.0, 0.4);
  (void)on(10.0);
  (void)lose_the_way();
  EXPECT_EQ(ordered_back.size(), 1u) << "nothing was written since";
}

TEST_F(Sets, WhatWasWrittenLatelyIsOrderedBackWhereAPersonSaysWhereTheRobotIs) {
  (void)on(60.0);
  end_set(2.0, 1);
  ASSERT_EQ(on(5.0).size(), 1u);
  TrackedScan elsewhere = robot.next();
  ++elsewhere.estimate.relocalizations;
  std::vector<ScanSet> handed_on;
  take(elsewhere, handed_on);
  EXPECT_EQ(ordered_back.size(), 1u);
  EXPECT_EQ(sets.gate().reason(), GateReason::kRelocalized);
}

TEST_F(Sets, AnOrderGoesBeforeTheSetsThatItMarks) {
  (void)on(60.0);
  end_set(2.0, 1);
  ASSERT_EQ(on(5.0).size(), 1u);
  end_set(2.0, 2);
  TrackedScan lost = robot.next();
  lost.estimate.state = LocalizerState::kLost;
  sets.observe(lost);
  const auto first = sets.next();
  ASSERT_TRUE(first && std::holds_alternative<WithdrawOrder>(*first));
  sets.observe(lost);
  const auto second = sets.next();
  ASSERT_TRUE(second && std::holds_alternative<ScanSet>(*second));
  EXPECT_TRUE(std::get<ScanSet>(*second).pose_in_doubt);
}

TEST_F(Sets, WhatIsSettledStaysAndThatIsSaidOnce) {
  (void)on(60.0);
  end_set(2.0, 1);
  ASSERT_EQ(on(40.0).size(), 1u);
  ASSERT_EQ(settled_at_s.size(), 1u);
  EXPECT_NEAR(settled_at_s[0], 60.0 + 30.0, 0.5);
  EXPECT_TRUE(lose_the_way().empty());
  EXPECT_TRUE(ordered_back.empty());
}

// --- what the run before has left ---

TEST_F(Sets, WhatTheRunBeforeHasLeftIsSettledOnceThePoseHasHeld) {
  sets = GatedSets{{}, true};
  (void)on(25.0);
  EXPECT_TRUE(settled_at_s.empty());
  (void)on(20.0);
  ASSERT_EQ(settled_at_s.size(), 1u);
  EXPECT_NEAR(settled_at_s[0], 30.0, 0.5);
  (void)lose_the_way();
  EXPECT_TRUE(ordered_back.empty());
}

TEST_F(Sets, WhatTheRunBeforeHasLeftIsOrderedBackWhereThePoseProvesWrong) {
  sets = GatedSets{{}, true};
  (void)on(25.0);
  (void)lose_the_way();
  ASSERT_EQ(ordered_back.size(), 1u);
  EXPECT_EQ(ordered_back[0].from, Timestamp::min());
  (void)on(60.0);
  (void)lose_the_way();
  EXPECT_EQ(ordered_back.size(), 1u) << "nothing was written since";
  EXPECT_TRUE(settled_at_s.empty());
}

TEST_F(Sets, OfTheRunBeforeAreOrderedBackWhereItsPoseDoesNotFitAndNotWhileItIsLookedAt) {
  sets = GatedSets{{}, true};
  std::vector<ScanSet> handed_on;
  TrackedScan tracked = robot.next();
  tracked.estimate.state = LocalizerState::kGlobal;
  tracked.estimate.checks_pose = true;
  take(tracked, handed_on);
  EXPECT_TRUE(ordered_back.empty());
  tracked = robot.next();
  tracked.estimate.state = LocalizerState::kGlobal;
  take(tracked, handed_on);
  EXPECT_EQ(ordered_back.size(), 1u);
}

TEST_F(Sets, NothingIsOrderedBackWhereTheFirstRunBeginsWithASearch) {
  std::vector<ScanSet> handed_on;
  TrackedScan tracked = robot.next();
  tracked.estimate.state = LocalizerState::kGlobal;
  take(tracked, handed_on);
  EXPECT_TRUE(ordered_back.empty());
}

TEST_F(Sets, AllPassAShutGateThatIsOff) {
  WriteGateParams off;
  off.enabled = false;
  sets = GatedSets{off};
  (void)on(10.0);
  (void)lose_the_way();
  EXPECT_TRUE(sets.lets_vote());
  end_set(2.0, 1);
  const auto handed_on = on(kPeriod_s);
  ASSERT_EQ(handed_on.size(), 1u);
  EXPECT_FALSE(handed_on[0].pose_in_doubt);
}

}  // namespace
}  // namespace deltamap::mapping::gate
