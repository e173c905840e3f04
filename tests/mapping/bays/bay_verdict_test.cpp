// SPDX-License-Identifier: Apache-2.0
#include "mapping/bays/bay_verdict.hpp"

#include <gtest/gtest.h>

namespace deltamap::mapping::bays {
namespace {

TEST(BayVerdict, FreeFloorIsEmptyWhereThreeQuartersWereSeen) {
  EXPECT_EQ(shown_state({.cells = 100, .free = 75}, BayState::kUnknown), BayState::kEmpty);
  EXPECT_EQ(shown_state({.cells = 100, .free = 74}, BayState::kUnknown), std::nullopt);
}

TEST(BayVerdict, AFaceAndTheShadowBehindItAreFull) {
  EXPECT_EQ(shown_state({.cells = 100, .free = 5, .free_since = 5, .taken = 10, .shadowed = 80, .body = true},
                        BayState::kUnknown),
            BayState::kFull);
  EXPECT_EQ(shown_state({.cells = 100, .free = 0, .taken = 10, .shadowed = 50, .body = true}, BayState::kUnknown),
            std::nullopt)
      << "too little is known";
}

TEST(BayVerdict, OnTheBorderOfTwoStatesTheOldOneStays) {
  const FloorCounts most{.cells = 100, .free = 12, .free_since = 12, .taken = 10, .shadowed = 70, .body = true};
  EXPECT_EQ(shown_state(most, BayState::kFull), BayState::kFull);
  EXPECT_EQ(shown_state(most, BayState::kPartly), BayState::kPartly);
}

TEST(BayVerdict, OnlyAnotherLoadFillsAtOnceWhatWasPartlyFull) {
  FloorCounts shadow{.cells = 100, .taken = 10, .shadowed = 75, .body = true};
  EXPECT_EQ(shown_state(shadow, BayState::kUnknown), BayState::kFull);
  EXPECT_EQ(shown_state(shadow, BayState::kPartly), std::nullopt) << "it may be that of the load that is known";
  shadow.risen = 6;
  EXPECT_EQ(shown_state(shadow, BayState::kPartly), BayState::kFull);
}

TEST(BayVerdict, AnotherLoadInAFullBayIsJudgedByWhatItShows) {
  FloorCounts shadow{.cells = 100, .free = 12, .free_since = 12, .taken = 10, .shadowed = 70, .body = true};
  EXPECT_EQ(shown_state(shadow, BayState::kFull), BayState::kFull);
  shadow.risen = 6;
  EXPECT_EQ(shown_state(shadow, BayState::kFull), BayState::kPartly);
  shadow.free = shadow.free_since = 5;
  EXPECT_EQ(shown_state(shadow, BayState::kFull), std::nullopt) << "its shadow may be long";
}

TEST(BayVerdict, FloorThatWasFreeBeforeTheLoadCameDoesNotTellHowMuchItTakes) {
  const FloorCounts before{.cells = 100, .free = 12, .free_since = 0, .taken = 10, .shadowed = 65, .body = true};
  EXPECT_EQ(shown_state(before, BayState::kUnknown), std::nullopt);
}

TEST(BayVerdict, TheShadowOfANeighboursLoadTakesNothing) {
  const FloorCounts corner{.cells = 100, .free = 80, .free_since = 80, .taken = 0, .shadowed = 10, .body = true};
  EXPECT_EQ(shown_state(corner, BayState::kEmpty), BayState::kEmpty);
}

TEST(BayVerdict, ALoadThatIsKnownStaysWhileOnlyItsShadowIsSeen) {
  const FloorCounts flush{.cells = 100, .free = 86, .free_since = 86, .shadowed = 14, .body = true};  // face on the rim
  EXPECT_EQ(shown_state(flush, BayState::kPartly), BayState::kPartly);
  EXPECT_EQ(shown_state(flush, BayState::kEmpty), BayState::kEmpty) << "a neighbour's";
}

TEST(BayVerdict, WhereSomebodyStandsNothingNewIsTold) {
  EXPECT_EQ(shown_state({.cells = 100, .free = 90, .small = 3}, BayState::kUnknown), std::nullopt);
}

TEST(BayVerdict, AStateIsContradictedByMuchThatItCannotShow) {
  EXPECT_TRUE(contradicts({.cells = 100, .free = 40}, BayState::kFull));
  EXPECT_FALSE(contradicts({.cells = 100, .free = 20}, BayState::kFull));
  EXPECT_FALSE(contradicts({.cells = 100, .taken = 30}, BayState::kEmpty)) << "no body";
  EXPECT_TRUE(contradicts({.cells = 100, .taken = 10, .shadowed = 20, .body = true}, BayState::kEmpty));
}

TEST(BayVerdict, WhatLiesBehindAFaceCountsLessThanWhatWasSeen) {
  EXPECT_DOUBLE_EQ(confidence_in({.cells = 100, .free = 50, .taken = 10, .shadowed = 40}), 0.92);
  EXPECT_DOUBLE_EQ(taken_share({.cells = 100, .free = 50, .taken = 10, .shadowed = 40}), 0.5);
  EXPECT_DOUBLE_EQ(taken_share({.cells = 100}), 0.0);
}

}  // namespace
}  // namespace deltamap::mapping::bays
