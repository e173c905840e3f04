// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/pushed.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/mapping/things/drawn_site.hpp"

namespace deltamap::mapping::things {
namespace {

// A body of 2.4 m × 2.0 m that is pushed by 0.5 m to the south.
constexpr Drawn kOld{4.0, 4.0, 6.4, 6.0};
constexpr Drawn kNew{4.0, 3.5, 6.4, 5.5};
const Outline kCame{{5.2, 3.75}, 2.4, 0.5, 0.0, {true, false, true, true}, {}};
const Outline kWent{{5.2, 5.75}, 2.4, 0.5, 0.0, {false, true, false, false}, {}};

class PushedBody : public testing::Test {
 protected:
  PushedBody() { site.fill({4.0, 4.0, 6.35, 5.95}, CellState::kUnknown).begin_with_what_is_drawn(); }
  DrawnSite site;
};

TEST_F(PushedBody, StripsOnBothSidesTellWhereItStoodAndStands) {
  const auto pushed = pushed_body(kCame, kWent, site.map);
  ASSERT_TRUE(pushed);
  expect_outline(pushed->from, kOld);
  expect_outline(pushed->at, kNew);
  EXPECT_EQ(pushed->at.seen, (std::array<bool, 4>{false, false, false, true}));
  EXPECT_EQ(pushed->from.seen, (std::array<bool, 4>{false, true, false, false}));
}

TEST_F(PushedBody, AStripThatWasSeenInPartIsEnough) {
  Outline part = kWent;
  part.length_m = 1.4;
  part.centre.x() -= 0.5;
  const auto pushed = pushed_body(kCame, part, site.map);
  ASSERT_TRUE(pushed);
  expect_outline(pushed->at, kNew);
  part.centre.x() -= 0.5;
  EXPECT_FALSE(pushed_body(kCame, part, site.map)) << "it reaches beyond the other";
}

TEST_F(PushedBody, StripsOfDifferentDepthsBelongToTwoBodies) {
  Outline deeper = kWent;
  deeper.width_m = 0.8;
  EXPECT_FALSE(pushed_body(kCame, deeper, site.map));
}

TEST_F(PushedBody, StripsThatAreNotParallelBelongToTwoBodies) {
  Outline turned = kWent;
  turned.heading_rad = 20.0 * std::numbers::pi / 180.0;
  EXPECT_FALSE(pushed_body(kCame, turned, site.map));
}

TEST_F(PushedBody, AStripThatWasSeenFromTheSideIsAFaceAtItsEnd) {
  const Outline face{{6.4, 3.75}, 0.5, 0.05, std::numbers::pi / 2, {false, true, false, false}, {}};
  const auto pushed = pushed_body(face, kWent, site.map);
  ASSERT_TRUE(pushed);
  expect_outline(pushed->from, kOld);
  expect_outline(pushed->at, kNew);
  Outline beyond = face;
  beyond.centre.x() += 0.5;
  EXPECT_FALSE(pushed_body(beyond, kWent, site.map)) << "it belongs to a neighbour";
}

TEST_F(PushedBody, IsFoundWhenTheFloorOfItsOldPlaceHasCome) {
  site.box(kOld).begin_with_what_is_drawn();
  site.south(kNew).fill({4.0, 3.5, 4.0, 3.95}, CellState::kOccupied).fill({6.4, 3.5, 6.4, 3.95}, CellState::kOccupied);
  ASSERT_EQ(site.fill({4.05, 3.55, 6.35, 3.95}, CellState::kUnknown).revision(10.0).size(), 1u);
  site.clear({4.0, 6.0, 6.4, 6.0}).revision(300.0);
  EXPECT_EQ(site.things.all().size(), 2u) << "how far it has gone is not known";
  site.clear({4.05, 5.55, 6.35, 5.95}).revision(302.0);
  ASSERT_EQ(site.things.all().size(), 1u);
  EXPECT_EQ(site.things.all()[0].kind, ThingKind::kMoved);
}

TEST_F(PushedBody, FloorBetweenThemIsNoBody) {
  EXPECT_FALSE(pushed_body(kCame, kWent, site.fill(kOld, CellState::kFree).next));
}

TEST_F(PushedBody, ThatIsDeeperThanWideTurnsItsHeading) {
  Outline came = kCame;
  Outline went = kWent;
  came.length_m = went.length_m = 1.2;
  const auto pushed = pushed_body(came, went, site.map);
  ASSERT_TRUE(pushed);
  EXPECT_NEAR(pushed->at.heading_rad, std::numbers::pi / 2, 1e-9);
  EXPECT_NEAR(pushed->at.length_m, 2.0, 1e-9);
  EXPECT_EQ(pushed->at.seen, (std::array<bool, 4>{false, false, true, false})) << "its southern side";
}

TEST_F(PushedBody, IsOneThingThatMoved) {
  site.box(kOld).begin_with_what_is_drawn();
  site.fill({4.0, 3.5, 6.4, 3.95}, CellState::kUnknown).south(kNew);
  site.fill({4.0, 3.5, 4.0, 3.95}, CellState::kOccupied).fill({6.4, 3.5, 6.4, 3.95}, CellState::kOccupied);
  const auto came = site.revision(10.0);
  ASSERT_EQ(came.size(), 1u);
  EXPECT_EQ(came[0].thing.kind, ThingKind::kAppeared);
  const auto went = site.clear({4.0, 5.55, 6.4, 6.0}).revision(300.0);
  ASSERT_EQ(went.size(), 1u);
  EXPECT_EQ(went[0].thing.id, came[0].thing.id);
  EXPECT_EQ(went[0].thing.kind, ThingKind::kMoved);
  expect_outline(*went[0].thing.from, kOld);
  expect_outline(*went[0].thing.at, kNew);

  site.fill({8.0, 8.0, 9.0, 9.0}, CellState::kOccupied).revision(310.0);
  expect_outline(*site.things.all()[0].at, kNew);
  const auto undone = site.undo(2, 400.0);
  ASSERT_FALSE(undone.empty());
  const Thing thing = site.things.all()[0];
  EXPECT_EQ(thing.kind, ThingKind::kAppeared) << "the going was taken back, and what came stands";
  EXPECT_FALSE(thing.from);
}

// A body that closes off a bay of 2.4 m between two walls, and is pushed into it by 0.5 m.
constexpr Drawn kInBay{4.0, 0.05, 6.4, 2.5};
constexpr Drawn kDeeper{4.0, 0.05, 6.4, 2.0};

class PushedBack : public testing::Test {
 protected:
  PushedBack() {
    site.fill({3.95, 0.05, 3.95, 3.0}, CellState::kOccupied).fill({6.45, 0.05, 6.45, 3.0}, CellState::kOccupied);
    site.begin_with_what_is_drawn();
    site.fill(kInBay, CellState::kUnknown).north(kInBay).revision(10.0);
  }
  DrawnSite site;
};

TEST_F(PushedBack, ItsNewFrontTellsHowFar) {
  ASSERT_EQ(site.things.all().size(), 1u);
  const Outline stood = *site.things.all()[0].at;
  EXPECT_FALSE(pushed_back(stood, site.map)) << "its front stands";
  site.clear({4.0, 2.12, 6.4, 2.5});
  EXPECT_FALSE(pushed_back(stood, site.next)) << "no front is seen";
  const auto at = pushed_back(stood, site.north(kDeeper).next);
  ASSERT_TRUE(at);
  EXPECT_NEAR(at->centre.y(), stood.centre.y() - 0.5, kCells_m);
  EXPECT_EQ(at->length_m, stood.length_m);
  EXPECT_FALSE(pushed_back(stood, site.clear({4.0, 0.05, 6.4, 1.9}).next)) << "floor behind it: another's side";
}

TEST_F(PushedBack, IsOneThingThatMoved) {
  site.clear({4.0, 2.12, 6.4, 2.5}).revision(100.0);
  EXPECT_EQ(site.things.all()[0].kind, ThingKind::kGone) << "nobody knows yet";
  const auto told = site.north(kDeeper).revision(110.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_TRUE(told[0].is_new);
  EXPECT_EQ(told[0].thing.id, 1u);
  EXPECT_EQ(told[0].thing.kind, ThingKind::kMoved);
  EXPECT_NEAR(told[0].thing.at->centre.y(), told[0].thing.from->centre.y() - 0.5, kCells_m);
  site.clear({4.0, 0.05, 6.4, 2.0}).revision(500.0);
  EXPECT_NE(site.things.all()[0].kind, ThingKind::kMoved) << "it has left the bay";
}

TEST_F(PushedBack, AnUndoneOneStandsWhereItStood) {
  const Outline stood = *site.things.all()[0].at;
  site.clear({4.0, 2.12, 6.4, 2.5}).revision(100.0);
  site.north(kDeeper).revision(110.0);
  ASSERT_EQ(site.things.all()[0].kind, ThingKind::kMoved);
  const auto unseen = site.undo(3, 400.0);
  ASSERT_EQ(unseen.size(), 1u);
  EXPECT_EQ(unseen[0].thing.kind, ThingKind::kGone) << "nobody knows where to";
  EXPECT_EQ(*unseen[0].thing.from, stood);
  const auto back = site.undo(2, 410.0);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0].thing.id, 1u);
  EXPECT_EQ(back[0].thing.kind, ThingKind::kAppeared);
  EXPECT_FALSE(back[0].thing.from);
  expect_outline(*back[0].thing.at, kInBay);
  site.clear(kInBay).revision(900.0);
  EXPECT_EQ(site.things.all()[0].kind, ThingKind::kGone);
}

TEST_F(PushedBack, AnUndoOfItsFirstRevisionAlonePutsItBackToo) {
  site.clear({4.0, 2.12, 6.4, 2.5}).revision(100.0);
  site.north(kDeeper).revision(110.0);
  const auto back = site.undo(2, 400.0);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0].thing.kind, ThingKind::kAppeared);
  EXPECT_FALSE(back[0].thing.from);
  expect_outline(*back[0].thing.at, kInBay);
}

TEST_F(PushedBack, ARollbackPutsItBack) {
  const OccupancyGrid stood = site.map;
  site.clear({4.0, 2.12, 6.4, 2.5}).revision(100.0);
  site.north(kDeeper).revision(110.0);
  site.next = stood;
  const auto back = site.revision(400.0, true);
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0].thing.kind, ThingKind::kAppeared);
  EXPECT_FALSE(back[0].thing.from);
  expect_outline(*back[0].thing.at, kInBay);
}

TEST_F(PushedBack, AnUndoOfItsComingTakesItBack) {
  site.clear({4.0, 2.12, 6.4, 2.5}).revision(100.0);
  site.north(kDeeper).revision(110.0);
  site.clear(kInBay);
  const auto told = site.revision(400.0, true);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].thing.kind, ThingKind::kTakenBack);
}

TEST_F(PushedBack, AnotherOnFloorThatWasSeenFreeIsAnother) {
  site.clear(kInBay).revision(100.0);
  site.fill(kDeeper, CellState::kUnknown).north(kDeeper).revision(140.0);
  ASSERT_EQ(site.things.all().size(), 2u);
  EXPECT_EQ(site.things.all()[0].kind, ThingKind::kGone);
  EXPECT_EQ(site.things.all()[1].kind, ThingKind::kAppeared);
}

TEST_F(PushedBody, ThatIsPushedBackHasMovedOn) {
  site.box(kOld).begin_with_what_is_drawn();
  site.fill({4.0, 3.5, 6.4, 3.95}, CellState::kUnknown).south(kNew);
  site.fill({4.0, 3.5, 4.0, 3.95}, CellState::kOccupied).fill({6.4, 3.5, 6.4, 3.95}, CellState::kOccupied);
  site.revision(10.0);
  ASSERT_EQ(site.clear({4.0, 5.55, 6.4, 6.0}).revision(300.0)[0].thing.kind, ThingKind::kMoved);
  const auto told = site.clear({4.0, 3.5, 6.4, 3.95}).revision(500.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_TRUE(told[0].is_new) << "another move";
  EXPECT_EQ(told[0].thing.kind, ThingKind::kMoved);
  expect_outline(*told[0].thing.from, kNew);
  expect_outline(*told[0].thing.at, kOld);
  DrawnSite undoing = site;
  const auto undone = undoing.undo(3, 600.0);
  ASSERT_EQ(undone.size(), 1u);
  EXPECT_EQ(undone[0].thing.kind, ThingKind::kAppeared);
  EXPECT_FALSE(undone[0].thing.from);
  expect_outline(*undone[0].thing.at, kNew);
  site.clear(kOld).revision(900.0);
  EXPECT_FALSE(site.things.all()[0].at) << "it has left for good";
}

}  // namespace
}  // namespace deltamap::mapping::things
