// SPDX-License-Identifier: Apache-2.0
// Faces of one body, and the two ends of a move.
#include <gtest/gtest.h>

#include "tests/mapping/things/drawn_site.hpp"

namespace deltamap::mapping::things {
namespace {

TEST(UnitedBodies, FacesThatAreSeenApartFromEachOtherAreOneBody) {
  DrawnSite site;
  site.south({4.0, 4.0, 6.2, 5.6}).revision(10.0);
  site.fill({6.4, 4.6, 6.4, 5.6}, CellState::kOccupied).revision(20.0);  // the corner between them was hidden
  ASSERT_EQ(site.things.all().size(), 1u);
  expect_outline(*site.things.all()[0].at, kBox);
}

TEST(UnitedBodies, ABoxThatIsPushedAsideHasMoved) {
  DrawnSite site;
  site.box(kBox).begin_with_what_is_drawn();
  const Drawn aside{4.6, 4.3, 7.0, 5.9};
  site.clear(kBox).revision(10.0);
  const auto told = site.box(aside).revision(20.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].thing.kind, ThingKind::kMoved);
  EXPECT_EQ(told[0].thing.id, 1u) << "it is the one that was told to have gone";
  expect_outline(*told[0].thing.from, kBox);
  expect_outline(*told[0].thing.at, aside);
  EXPECT_EQ(site.things.all().size(), 1u);
}

TEST(UnitedBodies, WhatComesLongAfterAnotherWentHasNotMoved) {
  DrawnSite site;
  site.box(kBox).begin_with_what_is_drawn();
  site.clear(kBox).revision(10.0);
  const auto told = site.box({4.6, 4.3, 7.0, 5.9}).revision(1000.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].thing.kind, ThingKind::kAppeared);
  EXPECT_EQ(told[0].thing.id, 2u);
}

TEST(UnitedBodies, EndsThatBeganAtTheSameTimeAreOfOneMoveHoweverLateTheyAreWhole) {
  DrawnSite site;
  const Drawn aside{4.0, 5.0, 6.4, 6.6};
  site.box(kBox).begin_with_what_is_drawn();
  site.clear({4.0, 4.0, 6.0, 5.6}).revision(10.0);  // its eastern side is hidden
  site.fill({5.4, 6.6, 6.4, 6.6}, CellState::kOccupied).fill({6.4, 5.8, 6.4, 6.6}, CellState::kOccupied).revision(12.0);
  site.clear({6.05, 4.0, 6.4, 5.6}).revision(300.0);
  EXPECT_EQ(site.things.all().size(), 2u) << "of two sizes";
  site.box(aside).revision(310.0);
  ASSERT_EQ(site.things.all().size(), 1u);
  EXPECT_EQ(site.things.all()[0].kind, ThingKind::kMoved);
}

TEST(UnitedBodies, ABoxOfAnotherSizeHasNotMoved) {
  DrawnSite site;
  site.box(kBox).begin_with_what_is_drawn();
  site.clear(kBox).revision(10.0);
  const auto told = site.box({4.6, 4.3, 5.6, 5.0}).revision(20.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].thing.kind, ThingKind::kAppeared);
}

TEST(UnitedBodies, AFaceAcrossTheWholeLengthOfAHallGrowsIntoOne) {
  DrawnSite site;
  for (int piece = 0; piece < 8; ++piece)
    site.fill({1.0 + piece, 5.0, 1.9 + piece, 5.0}, CellState::kOccupied).revision(10.0 + piece);
  ASSERT_EQ(site.things.all().size(), 1u);
  EXPECT_NEAR(site.things.all()[0].at->length_m, 7.9, kCells_m);
}

TEST(UnitedBodies, WhatIsNoLongerFollowedStillGoesUnderItsId) {
  DrawnSite site{{.most_cell_bytes = 1}};
  site.box(kBox).revision(10.0);
  const auto told = site.clear(kBox).revision(500.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].thing.id, 1u);
  EXPECT_EQ(told[0].thing.kind, ThingKind::kGone);
}

TEST(UnitedBodies, AnUndoTellsNoMove) {
  DrawnSite site;
  site.box(kBox).begin_with_what_is_drawn();
  (void)site.clear({4.0, 4.0, 6.0, 5.6}).revision(10);  // all but its east
  const Drawn beside{4.0, 4.8, 6.4, 6.4};
  (void)site.north(beside).west(beside).revision(12);
  (void)site.north({4.0, 4.8, 7.0, 6.4}).revision(14);
  (void)site.clear({6.0, 4.0, 6.4, 5.6}).revision(300);
  for (const ThingEvent& event : site.undo(3, 400.0)) {
    EXPECT_NE(event.thing.kind, ThingKind::kMoved) << words_of(event.thing);
    EXPECT_NE(event.thing.kind, ThingKind::kJoined) << words_of(event.thing);
  }
}

TEST(UnitedBodies, AnUndoneMoveLeavesTheThingWhereItStood) {
  for (const bool in_one_revision : {true, false}) {
    DrawnSite site;
    site.box(kBox).revision(10.0);
    site.clear(kBox);
    if (!in_one_revision) site.revision(500.0);
    site.box({4.6, 4.3, 7.0, 5.9}).revision(510.0);
    ASSERT_EQ(site.things.all().size(), 1u);
    ASSERT_EQ(site.things.all()[0].kind, ThingKind::kMoved);
    if (!in_one_revision) {
      EXPECT_EQ(site.undo(3, 600.0).at(0).thing.kind, ThingKind::kGone) << "nobody knows where to";
    }
    const auto back = site.undo(2, 610.0);
    ASSERT_EQ(back.size(), 1u);
    EXPECT_EQ(back[0].thing.kind, ThingKind::kAppeared);
    EXPECT_EQ(back[0].thing.id, 1u);
    EXPECT_FALSE(back[0].thing.from);
    expect_outline(*back[0].thing.at, kBox);
  }
}

TEST(UnitedBodies, AnUndoneMoveOfWhatStoodFromTheBeginningIsTakenBack) {
  DrawnSite site;
  site.box(kBox).begin_with_what_is_drawn();
  site.clear(kBox).revision(10.0);
  site.box({4.6, 4.3, 7.0, 5.9}).revision(20.0);
  ASSERT_EQ(site.things.all()[0].kind, ThingKind::kMoved);
  EXPECT_EQ(site.undo(2, 600.0).at(0).thing.kind, ThingKind::kGone);
  EXPECT_EQ(site.undo(1, 610.0).at(0).thing.kind, ThingKind::kTakenBack) << "it never went";
}

}  // namespace
}  // namespace deltamap::mapping::things
