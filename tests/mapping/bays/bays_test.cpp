// SPDX-License-Identifier: Apache-2.0
#include "mapping/bays/bays.hpp"

#include "tests/mapping/bays/seen_bays.hpp"

namespace deltamap::mapping::bays {
namespace {

TEST_F(SeenBays, UntilSomebodyLooksABayIsUnknown) {
  look({16.0, 4.0, radians(-90.0)}, 20.0);  // away from it
  EXPECT_EQ(status(), BayStatus{});
}

TEST_F(SeenBays, AnEmptyBayIsToldEmptyWithinThreeSeconds) {
  const auto events = look(kBefore, 3.0);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].before, BayState::kUnknown);
  EXPECT_EQ(status().state, BayState::kEmpty);
  EXPECT_LT(status().share, 0.05);
  EXPECT_GT(status().confidence, 0.75);
  EXPECT_LE(age_s(), 1.0);
}

TEST_F(SeenBays, AContainerOfWhichOneFaceIsSeenFillsItsBay) {
  for (const Pose2& from : {kBefore, kAside}) {
    bays = Bays{bays.bays()};
    rebuild({{kBay, {2.4, 2.4}}});
    look(from, 3.0);
    EXPECT_EQ(status().state, BayState::kFull);
    EXPECT_GT(status().share, 0.9);
  }
}

TEST_F(SeenBays, AContainerThatStandsBeforeItsLineFillsItsBayToo) {
  rebuild({{kBay + Point2{0.05, -0.15}, {2.4, 2.4}}});
  look(kBefore, 3.0);
  EXPECT_EQ(status().state, BayState::kFull);
}

TEST_F(SeenBays, WhatComesAndGoesIsToldWithinThreeSeconds) {
  look(kBefore, 6.0);
  rebuild({{kBay, {2.4, 2.4}}});
  look(kBefore, 3.0);
  EXPECT_EQ(status().state, BayState::kFull);
  rebuild({});
  const Timestamp gone = now;
  const auto events = look(kBefore, 3.0);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].before, BayState::kFull);
  EXPECT_EQ(status().state, BayState::kEmpty);
  EXPECT_GT(*status().since, gone);
  EXPECT_LT(seconds(*status().since - gone), 2.5);
}

TEST_F(SeenBays, APalletTakesAPartOfItsBay) {
  rebuild({{kBay + Point2{0.2, 0.8}, {1.2, 0.8}}});
  look(kBefore, 2.0);
  look({6.0, 7.0, radians(30.0)}, 2.0);
  look({12.4, 7.0, radians(150.0)}, 2.0);
  EXPECT_EQ(status().state, BayState::kPartly);
  EXPECT_GT(status().share, 0.1);
  EXPECT_LT(status().share, 0.5);
}

TEST_F(SeenBays, WhereTheViewIsCoveredTheOldStateStaysAndAges) {
  look(kBefore, 3.0);
  rebuild({{{6.0, 5.0}, {6.4, 1.0}}, {kBay, {2.4, 2.4}}});  // a lorry before it, and a container comes unseen
  EXPECT_TRUE(look(kBefore, 10.0).empty());
  EXPECT_EQ(status().state, BayState::kEmpty);
  EXPECT_GE(age_s(), 10.0);
}

TEST_F(SeenBays, BehindACoverNothingIsGuessed) {
  rebuild({{{6.0, 5.0}, {6.4, 1.0}}});
  look(kBefore, 10.0);
  EXPECT_EQ(status(), BayStatus{});
}

TEST_F(SeenBays, HalfAViewIsNotEnough) {
  rebuild({{{9.1, 5.0}, {4.0, 1.0}}});  // covers the right half
  look(kBefore, 10.0);
  EXPECT_EQ(status(), BayStatus{});
}

TEST_F(SeenBays, NeighboursThatAreFullAndAWallBehindTakeNothing) {
  rebuild(
      {{kBay + Point2{2.35, 0.0}, {2.4, 2.4}}, {kBay - Point2{2.35, 0.0}, {2.4, 2.4}}, {{0.0, 10.37}, {24.0, 0.2}}});
  look(kBefore, 5.0);
  EXPECT_EQ(status().state, BayState::kEmpty);
  look({6.5, 5.5, radians(45.0)}, 3.0);
  EXPECT_EQ(status().state, BayState::kEmpty);
}

TEST_F(SeenBays, SomebodyWhoWalksThroughOrWaitsInTheBayTakesNothing) {
  look(kBefore, 3.0);
  for (int step = 0; step < 60; ++step) {
    const double x_m = kBay.x() + 0.05 * std::min(step, 24);  // slowly, then he waits
    rebuild({{{x_m, 8.6}, {0.45, 0.45}}});
    EXPECT_TRUE(look(kBefore, 0.2).empty()) << step;
  }
  EXPECT_EQ(status().state, BayState::kEmpty);
}

TEST_F(SeenBays, AStateIsNeverYoungerThanWhatItWasSeenBy) {
  look(kBefore, 6.0);
  rebuild({{kBay, {2.4, 2.4}}});
  const Timestamp came = now;
  while (look(kBefore, 0.2).empty()) EXPECT_LE(*status().seen, came);
  EXPECT_GT(*status().seen, came);
}

TEST_F(SeenBays, AStateIsSeenNoEarlierThanItBegan) {
  look(kBefore, 6.0);
  rebuild({{kBay + Point2{1.4, 1.2}, {0.8, 0.8}}, {{6.0, 5.0}, {3.15, 1.0}}});  // and two fifths are covered
  const std::vector<BayEvent> told = look(kBefore, 4.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].status.state, BayState::kPartly);
  EXPECT_GE(*told[0].status.seen, *told[0].status.since);
}

TEST_F(SeenBays, APalletThatIsSeenFromItsNarrowSideIsToldWithinThreeSeconds) {
  look(kBefore, 6.0);
  rebuild({{kBay + Point2{0.8, 0.6}, {0.8, 1.2}}});
  look(kBefore, 3.0);
  EXPECT_EQ(status().state, BayState::kPartly);
}

TEST_F(SeenBays, WhatIsThereNoLongerAndNotSeenWholeIsUnknown) {
  rebuild({{kBay, {2.4, 2.4}}});
  look(kBefore, 3.0);
  ASSERT_EQ(status().state, BayState::kFull);
  rebuild({{{9.25, 5.0}, {4.0, 1.0}}});  // it has left, and the right half is covered
  look(kBefore, 8.0);
  EXPECT_EQ(status().state, BayState::kUnknown);
  EXPECT_TRUE(status().since);
}

TEST_F(SeenBays, WhileThePoseIsInDoubtNothingIsJudged) {
  EXPECT_TRUE(look(kBefore, 5.0, false).empty());
  EXPECT_EQ(status(), BayStatus{});
}

TEST_F(SeenBays, WhatAWrongPoseHasSeenIsForgotten) {
  look(kBefore, 5.0);
  const Timestamp wrong = now;
  EXPECT_TRUE(bays.forget_since(wrong + duration_from_seconds(0.1), now).empty()) << "it was seen before";
  look(kBefore, 2.0);
  const auto events = bays.forget_since(wrong, now);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(status().state, BayState::kUnknown);
  EXPECT_FALSE(status().seen);
  look(kBefore, 3.0);
  EXPECT_EQ(status().state, BayState::kEmpty);
}

TEST_F(SeenBays, OfBaysThatStayAsTheyWereAllThatIsKnownIsKept) {
  look(kBefore, 3.0);
  const BayStatus known = status();
  Bay renamed = bays.bays()[0];
  renamed.name = "Row B";
  Bay moved = renamed;
  moved.id = "B5";
  moved.polygon = square(kBay + Point2{3.0, 0.0}, kSide_m);
  bays.set({moved, renamed});
  EXPECT_EQ(status(0), BayStatus{});
  EXPECT_EQ(status(1), known);
  EXPECT_EQ(bays.bays()[1].name, "Row B");
}

TEST_F(SeenBays, TheSameScansTellTheSame) {
  rebuild({{kBay, {1.2, 2.4}}});
  const auto first = look(kAside, 5.0);
  const BayStatus told = status();
  bays = Bays{bays.bays()};
  random = Random{3};
  now = timestamp_from_ns(1'000'000'000'000);
  EXPECT_EQ(look(kAside, 5.0).size(), first.size());
  EXPECT_EQ(status(), told);
}

}  // namespace
}  // namespace deltamap::mapping::bays
