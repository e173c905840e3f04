// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/things.hpp"

#include <gtest/gtest.h>

#include "tests/mapping/things/drawn_site.hpp"

namespace deltamap::mapping::things {
namespace {

int sides_seen(const Outline& outline) {
  return static_cast<int>(std::count(outline.seen.begin(), outline.seen.end(), true));
}

TEST(Things, ABoxSeenSideBySideIsOneEventThatGrows) {
  DrawnSite site;
  const auto first = site.south(kBox).revision(10.0);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_TRUE(first[0].is_new);
  EXPECT_EQ(first[0].thing.kind, ThingKind::kAppeared);
  EXPECT_EQ(sides_seen(*first[0].thing.at), 1);
  for (const auto& event : site.west(kBox).revision(40.0)) EXPECT_FALSE(event.is_new);
  for (const auto& event : site.north(kBox).revision(400.0)) EXPECT_FALSE(event.is_new) << "long after the first";
  for (const auto& event : site.east(kBox).revision(900.0)) EXPECT_FALSE(event.is_new);

  const std::vector<Thing> all = site.things.all();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].id, 1u);
  expect_outline(*all[0].at, kBox);
  EXPECT_EQ(sides_seen(*all[0].at), 4);
  EXPECT_EQ(all[0].revisions, (std::vector<std::uint32_t>{1, 2, 3, 4}));
  EXPECT_EQ(all[0].first_seen, DrawnSite::at(10.0));
  EXPECT_EQ(all[0].last_seen, DrawnSite::at(900.0));
  EXPECT_DOUBLE_EQ(all[0].confidence, 1.0);
}

TEST(Things, WhatAFaceClosesOffTellsItsDepth) {
  DrawnSite site;
  site.fill({4.0, 0.1, 4.0, 3.0}, CellState::kOccupied).fill({6.5, 0.1, 6.5, 3.0}, CellState::kOccupied);
  site.begin_with_what_is_drawn();  // a bay between two walls
  site.fill({4.05, 2.5, 6.45, 2.5}, CellState::kOccupied).fill({4.05, 0.1, 6.45, 2.45}, CellState::kUnknown);
  const auto told = site.revision(10.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NEAR(told[0].thing.at->length_m, 2.4, 2 * kCells_m);
  EXPECT_NEAR(told[0].thing.at->width_m, 2.4, 2 * kCells_m);
}

TEST(Things, AThingThatStoodThereFromTheBeginningGoes) {
  DrawnSite site;
  site.box(kBox).fill({4.05, 4.05, 6.35, 5.55}, CellState::kUnknown).begin_with_what_is_drawn();
  const auto told = site.clear(kBox).revision(10.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].thing.kind, ThingKind::kGone);
  EXPECT_FALSE(told[0].thing.at);
  expect_outline(*told[0].thing.from, kBox);
}

TEST(Things, WhatHasGoneKeepsItsOutlineWhileAnotherTakesSomeOfItsFloor) {
  DrawnSite site;
  site.box(kBox).fill({4.05, 4.05, 6.35, 5.55}, CellState::kUnknown).begin_with_what_is_drawn();
  site.clear(kBox).revision(10.0);
  const Drawn narrow{5.7, 4.0, 6.4, 5.6};
  site.fill(narrow, CellState::kUnknown).box(narrow).revision(1000.0);
  ASSERT_EQ(site.things.all().size(), 2u);
  expect_outline(*site.things.all()[0].from, kBox);
}

TEST(Things, OfABodyWhoseFrontAloneWasKnownTheFloorBehindTellsTheDepth) {
  DrawnSite site;
  const Drawn slot{4.0, 0.0, 6.4, 2.0};
  site.fill({0.0, 0.0, 11.95, 2.0}, CellState::kUnknown).fill({0.0, 2.0, 11.95, 2.0}, CellState::kOccupied);
  site.begin_with_what_is_drawn();  // a row along the wall
  site.clear({4.05, 0.05, 6.35, 2.0}).west(slot).east(slot).south(slot);
  const auto told = site.revision(10.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].thing.kind, ThingKind::kGone);
  EXPECT_NEAR(told[0].thing.from->length_m, 2.4, 2 * kCells_m);
  EXPECT_NEAR(told[0].thing.from->width_m, 2.0, 2 * kCells_m);
}

// Two containers side by side in a row whose fronts alone are known, the wall behind them.
constexpr Drawn kLeft{2.0, 0.05, 4.4, 2.4};
constexpr Drawn kRight{4.4, 0.05, 6.8, 2.4};

class Row : public testing::Test {
 protected:
  Row() {
    site.fill({0.05, 0.05, 11.9, 2.4}, CellState::kUnknown).fill({0.05, 2.4, 11.9, 2.4}, CellState::kOccupied);
    site.begin_with_what_is_drawn();
  }
  DrawnSite site;
};

TEST_F(Row, ANeighbourWhoseSideWasShownGoesAsAnother) {
  site.clear({2.05, 0.05, 4.35, 2.4}).west(kLeft).east(kLeft);
  ASSERT_EQ(site.revision(10.0).size(), 1u);
  const auto told = site.clear({4.4, 0.05, 6.75, 2.4}).east(kRight).revision(60.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].thing.id, 2u);
  expect_outline(*told[0].thing.from, kRight);
  expect_outline(*site.things.all()[0].from, kLeft);
}

TEST_F(Row, ANeighbourBehindASideThatWasShownInPartGoesAsAnother) {
  site.clear({2.05, 1.2, 4.35, 2.4}).fill({4.4, 1.2, 4.4, 2.35}, CellState::kOccupied);  // half as deep as it was
  ASSERT_EQ(site.revision(10.0).size(), 1u);
  const auto told = site.clear({4.6, 1.2, 6.75, 2.4}).revision(60.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].thing.id, 2u) << "the side still stands between them";
}

TEST_F(Row, ANeighbourOfWhatHasBeenReplacedGoesAsAnother) {
  site.clear({2.05, 0.05, 4.35, 2.4}).revision(10.0);
  site.fill({2.05, 0.05, 4.35, 2.35}, CellState::kUnknown).fill({2.0, 2.4, 4.4, 2.4}, CellState::kOccupied);
  ASSERT_EQ(site.revision(60.0).size(), 1u) << "another stands there";
  const auto told = site.clear({4.45, 0.05, 6.75, 2.4}).revision(120.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].thing.id, 3u);
  EXPECT_EQ(told[0].thing.kind, ThingKind::kGone);
}

TEST(Things, ABodyThatIsSeenToGoPieceByPieceIsOne) {
  DrawnSite site;  // in a row before a wall
  site.fill({1.0, 2.01, 9.0, 2.01}, CellState::kOccupied).fill({1.0, 2.06, 9.0, 4.36}, CellState::kUnknown);
  site.fill({1.0, 4.41, 9.0, 4.41}, CellState::kOccupied).begin_with_what_is_drawn();
  const Drawn body{4.01, 2.06, 6.41, 4.41};
  site.clear({5.61, 2.06, 6.36, 4.41}).east({4.01, 2.06, 6.41, 4.36});
  ASSERT_EQ(site.revision(10.0).size(), 1u);
  for (const ThingEvent& event : site.clear({4.81, 2.06, 5.56, 4.41}).revision(15.0)) EXPECT_FALSE(event.is_new);
  site.clear({4.06, 2.06, 4.76, 4.41}).west({4.01, 2.06, 6.41, 4.36}).revision(20.0);
  ASSERT_EQ(site.things.all().size(), 1u);
  expect_outline(*site.things.all()[0].from, body);
}

TEST(Things, FloorThatIsClosedOffAtOnceBelongsToTheFaceThatItLiesBehind) {
  DrawnSite site;
  site.fill({0.05, 3.0, 1.95, 3.0}, CellState::kOccupied).fill({6.85, 3.0, 11.9, 3.0}, CellState::kOccupied);
  site.begin_with_what_is_drawn();
  site.fill({2.0, 3.0, 4.2, 3.0}, CellState::kOccupied).revision(10.0);
  site.fill({4.6, 3.0, 6.8, 3.0}, CellState::kOccupied).revision(400.0);
  site.fill({2.0, 0.05, 6.8, 2.95}, CellState::kUnknown).revision(410.0);
  ASSERT_EQ(site.things.all().size(), 2u);
  EXPECT_NEAR(site.things.all()[0].at->centre.x(), 3.1, 0.3);
  EXPECT_NEAR(site.things.all()[1].at->centre.x(), 5.7, 0.3);
}

TEST(Things, AFaceThatGoesOnAfterMoreThanOneLookIsAnothers) {
  DrawnSite site;
  site.fill({2.0, 3.0, 4.2, 3.0}, CellState::kOccupied).revision(10.0);
  site.fill({4.25, 3.0, 5.0, 3.0}, CellState::kOccupied).revision(50.0);
  EXPECT_EQ(site.things.all().size(), 1u);
  site.fill({5.05, 3.0, 7.0, 3.0}, CellState::kOccupied).revision(150.0);
  EXPECT_EQ(site.things.all().size(), 2u);
}

TEST(Things, WhatAppearedGoesUnderTheSameId) {
  DrawnSite site;
  site.box(kBox).revision(10.0);
  const auto told = site.clear(kBox).revision(500.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_TRUE(told[0].is_new);
  EXPECT_EQ(told[0].thing.id, 1u);
  EXPECT_EQ(told[0].thing.kind, ThingKind::kGone);
  expect_outline(*told[0].thing.from, kBox);
  EXPECT_EQ(site.things.all().size(), 1u);
}

TEST(Things, WhatComesWhereAnotherWentIsANewThing) {
  DrawnSite site;
  site.box(kBox).revision(10.0);
  site.clear(kBox).revision(500.0);
  const auto told = site.box(kBox).revision(900.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].thing.id, 2u);
  EXPECT_EQ(told[0].thing.kind, ThingKind::kAppeared);
}

TEST(Things, TwoBoxesBesideEachOtherStayTwo) {
  DrawnSite site;
  const Drawn left{2.0, 4.0, 4.0, 6.0};
  const Drawn right{4.3, 4.0, 6.3, 6.0};
  site.box(left).box(right);
  ASSERT_EQ(site.revision(10.0).size(), 2u);
  expect_outline(*site.things.all()[0].at, left);
  expect_outline(*site.things.all()[1].at, right);
}

TEST(Things, ABoxPutAgainstAnotherIsASecondThing) {
  DrawnSite site;
  const Drawn first{2.0, 4.0, 4.0, 6.0};
  const Drawn second{4.05, 4.0, 6.05, 6.0};
  site.box(first).revision(10.0);
  const auto told = site.box(second).revision(60.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].thing.id, 2u);
  expect_outline(*told[0].thing.at, second);
}

TEST(Things, AWallThatIsCorrectedByACellIsNoThing) {
  DrawnSite site;
  site.fill({0.05, 2.0, 0.05, 7.0}, CellState::kOccupied).revision(10.0);  // one cell before the wall
  site.fill({0.05, 2.0, 0.05, 7.0}, CellState::kFree).revision(20.0);
  EXPECT_TRUE(site.things.all().empty());
  EXPECT_GE(site.things.corrections(), 200u);
}

TEST(Things, AFewCellsThatFlickerAreCorrections) {
  DrawnSite site;
  for (int i = 0; i < 10; ++i) {
    site.fill({5.0, 5.0, 5.05, 5.05}, i % 2 == 0 ? CellState::kOccupied : CellState::kFree);
    EXPECT_TRUE(site.revision(10.0 * i).empty());
  }
  EXPECT_TRUE(site.things.all().empty());
  EXPECT_GT(site.things.corrections(), 0u);
}

TEST(Things, AFaceThatComesAndGoesAgainAndAgainIsToldOnce) {
  DrawnSite site;
  std::size_t told = 0;
  for (int i = 0; i < 10; ++i) {
    site.fill({5.0, 5.0, 6.0, 5.0}, i % 2 == 0 ? CellState::kOccupied : CellState::kFree);
    told += site.revision(300.0 * i).size();
  }
  EXPECT_LE(told, 2u) << "glass: it came and went";
}

TEST(Things, AnUndoTakesAThingBack) {
  DrawnSite site;
  site.box(kBox).revision(10.0);
  const auto told = site.undo(1, 20.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].thing.kind, ThingKind::kTakenBack);
  EXPECT_EQ(told[0].thing.id, 1u);
}

TEST(Things, AnUndoOfWhatHasGoneBringsItBack) {
  DrawnSite site;
  site.box(kBox).begin_with_what_is_drawn();
  site.clear(kBox).revision(10.0);
  const auto told = site.undo(1, 20.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].thing.kind, ThingKind::kTakenBack) << "it never went";
}

TEST(Things, AnUndoOfAGoingLeavesTheThingWhereItStood) {
  DrawnSite site;
  site.box(kBox).revision(10.0);
  site.clear(kBox).revision(20.0);
  const auto told = site.undo(2, 30.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].thing.id, 1u);
  EXPECT_EQ(told[0].thing.kind, ThingKind::kAppeared);
  expect_outline(*told[0].thing.at, kBox);
}

TEST(Things, AnUndoOfAGoingGivesItsFloorToNoNeighbour) {
  const Drawn neighbour{4.0, 5.65, 4.0, 7.7};
  DrawnSite site;
  site.box(kBox).fill({4.05, 4.05, 6.35, 5.55}, CellState::kUnknown).begin_with_what_is_drawn();
  site.fill(neighbour, CellState::kOccupied).revision(10.0);
  const std::size_t cells = site.things.undoing(1, site.map).size();
  site.clear(kBox).revision(15.0);
  site.undo(2, 40.0);
  expect_outline(*site.things.all()[0].at, neighbour);
  EXPECT_EQ(site.things.undoing(1, site.map).size(), cells);
}

TEST(Things, WhatTakesBackTellsOfNothingNew) {
  DrawnSite site;
  EXPECT_TRUE(site.box(kBox).revision(10.0, true).empty());
}

TEST(Things, SmallMovesOfOneBodyAreOneEventThatIsUpdated) {
  DrawnSite site;
  site.box(kBox).revision(10.0);
  std::size_t news = 0;
  Drawn box = kBox;
  for (int i = 1; i <= 10; ++i) {
    site.clear(box);
    box.low_x += 0.1;
    box.high_x += 0.1;
    for (const auto& event : site.box(box).revision(10.0 + 60.0 * i)) news += event.is_new ? 1 : 0;
  }
  EXPECT_EQ(site.things.all().size(), 1u);
  EXPECT_LE(news, 1u) << "told once that it moves";
  expect_outline(*site.things.all()[0].at, box);
}

TEST(Things, TheSameRevisionsTellTheSame) {
  const auto run = [] {
    DrawnSite site;
    std::vector<ThingEvent> events;
    for (int i = 0; i < 6; ++i) {
      const Drawn box{1.0 + 1.6 * i, 2.0, 2.0 + 1.6 * i, 3.0 + 0.2 * i};
      for (auto& event : site.box(box).revision(10.0 * i)) events.push_back(event);
      if (i % 2 == 1) site.clear(box);
    }
    return std::pair{events, site.things.all()};
  };
  const auto [events, all] = run();
  const auto [events_again, all_again] = run();
  ASSERT_EQ(events.size(), events_again.size());
  for (std::size_t i = 0; i < events.size(); ++i) EXPECT_EQ(events[i].thing, events_again[i].thing);
  EXPECT_EQ(all, all_again);
}

TEST(Things, WhatIsFollowedCellByCellStaysWithinItsBounds) {
  DrawnSite site{{.most_cell_bytes = 20'000, .most_things = 20}};
  for (int i = 0; i < 60; ++i) {
    const Drawn box{0.5 + (i % 10) * 1.1, 0.5 + (i / 10 % 6) * 1.5, 1.1 + (i % 10) * 1.1, 1.3 + (i / 10 % 6) * 1.5};
    site.box(box).revision(100.0 * i);
  }
  EXPECT_LE(site.things.cell_bytes(), 20'000u);
  EXPECT_LE(site.things.all().size(), 20u);
  EXPECT_EQ(site.things.all().size() + site.things.forgotten(), 60u);
}

}  // namespace
}  // namespace deltamap::mapping::things
