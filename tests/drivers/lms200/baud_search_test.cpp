// SPDX-License-Identifier: Apache-2.0
#include "drivers/lms200/baud_search.hpp"

#include <gtest/gtest.h>

#include <map>

namespace deltamap::drivers::lms200 {
namespace {

using Bauds = std::vector<unsigned>;

/// The next visits to a laser of which nothing is heard.
Bauds silent_visits(VisitPlan& plan, int count) {
  Bauds visits;
  for (int i = 0; i < count; ++i) {
    visits.push_back(plan.baud());
    plan.advance(false, true);
  }
  return visits;
}

TEST(BaudSearch, TriesEachSpeedOnceAndTheLikeliestFirst) {
  EXPECT_EQ(baud_search(38400), (Bauds{38400, 9600, 500000, 19200}));
  EXPECT_EQ(baud_search(19200), (Bauds{19200, 38400, 9600, 500000}));
}

TEST(VisitPlan, GoesHomeEveryOtherTimeAndMostlyToTheSpeedAfterAPowerCutBetween) {
  VisitPlan plan{38400};
  EXPECT_EQ(silent_visits(plan, 12),
            (Bauds{38400, 9600, 38400, 9600, 38400, 9600, 38400, 9600, 38400, 9600, 38400, 500000}));
}

TEST(VisitPlan, LeavesOutNoSpeedWhereverHomeIs) {
  for (const unsigned home : {9600u, 19200u, 38400u, 500000u}) {
    VisitPlan plan{home};
    std::map<unsigned, int> visits;
    for (const unsigned baud : silent_visits(plan, 60)) ++visits[baud];
    EXPECT_EQ(visits.size(), 4u) << home;
    EXPECT_EQ(visits[home], 30) << home;
  }
}

TEST(VisitPlan, StaysAtHomeUntilTheSilenceIsLong) {
  VisitPlan plan{38400};
  plan.advance(false, false);
  EXPECT_EQ(plan.baud(), 38400u);
  plan.advance(true, false);
  EXPECT_EQ(plan.baud(), 9600u) << "garbage: a detour";
}

TEST(VisitPlan, TakesADetourForGarbageWhichIsNoVisitOfThePlan) {
  VisitPlan plan{38400};
  (void)silent_visits(plan, 10);
  ASSERT_EQ(plan.baud(), 38400u);
  plan.advance(true, true);
  EXPECT_EQ(plan.baud(), 9600u);
  plan.advance(true, true);
  EXPECT_EQ(plan.baud(), 500000u) << "two detours never follow each other, and the plan goes on where it was";
}

TEST(VisitPlan, KnowsNoDetourWhereHomeIsTheSpeedAfterAPowerCut) {
  VisitPlan plan{9600, true};
  EXPECT_EQ(silent_visits(plan, 4), (Bauds{9600, 38400, 9600, 500000}));
}

}  // namespace
}  // namespace deltamap::drivers::lms200
