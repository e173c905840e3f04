// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/assumed.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "tests/mapping/things/drawn_site.hpp"

namespace deltamap::mapping::things {
namespace {

std::ptrdiff_t sides(const std::array<bool, 4>& which) { return std::count(which.begin(), which.end(), true); }

/// Five beams side by side, from the west wall on, as far as `end_x` (m).
TrackedScan beams_eastward(double y, double end_x, double time_s) {
  TrackedScan tracked;
  tracked.scan.time = DrawnSite::at(time_s);
  tracked.estimate.map_from_robot = {1.0, y, 0.0};
  for (int i = -2; i <= 2; ++i) {
    const float beside_m = 0.1F * static_cast<float>(i);
    tracked.rays.push_back({{0.0F, beside_m}, {static_cast<float>(end_x - 1.0), beside_m}});
  }
  return tracked;
}

TEST(Assumed, TwoSeenSidesFixTheRectangleAndTheOthersAreAssumed) {
  DrawnSite site;
  const auto told = site.south(kBox).west(kBox).revision(10.0);
  ASSERT_EQ(told.size(), 1u);
  const Outline& outline = *told[0].thing.at;
  EXPECT_EQ(sides(outline.seen), 2);
  EXPECT_EQ(sides(outline.assumed), 2);
  for (std::size_t side = 0; side < 4; ++side) EXPECT_NE(outline.seen[side], outline.assumed[side]);
  EXPECT_TRUE(is_closed(outline));
  EXPECT_NE(words_of(told[0].thing).find("(2 sides assumed)"), std::string::npos) << words_of(told[0].thing);
}

TEST(Assumed, OneFaceFixesNoRectangle) {
  DrawnSite site;
  const auto told = site.south(kBox).revision(10.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(sides(told[0].thing.at->assumed), 0);
  EXPECT_TRUE(assumed_cells(site.things.all(), site.map).empty());
}

TEST(Assumed, SurfacesThatLieOnNoRectangleFixNone) {
  DrawnSite site;
  site.south(kBox).west(kBox);
  for (int i = 0; i <= 48; ++i) {  // a triangle
    const double x = 4.0 + 0.05 * i;
    site.fill({x, 5.6 - 1.6 / 2.4 * (x - 4.0), x, 5.65 - 1.6 / 2.4 * (x - 4.0)}, CellState::kOccupied);
  }
  const auto told = site.revision(10.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(sides(told[0].thing.at->assumed), 0);
}

TEST(Assumed, ABodyThatSticksOutOfARowMayGoOnBehindItsNeighbours) {
  DrawnSite site;
  site.fill({1.0, 5.0, 11.0, 7.0}, CellState::kUnknown).fill({1.0, 5.0, 4.0, 5.0}, CellState::kOccupied);
  site.fill({6.4, 5.0, 11.0, 5.0}, CellState::kOccupied).begin_with_what_is_drawn();
  const Drawn out{4.0, 4.2, 6.4, 4.95};
  const auto told = site.south(out).west(out).east(out).revision(10.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(sides(told[0].thing.at->seen), 3);
  EXPECT_EQ(sides(told[0].thing.at->assumed), 0);
}

TEST(Assumed, ASideAlongASurfaceOfTheMapGoesNoFarther) {
  DrawnSite site;
  site.fill({1.0, 5.65, 11.0, 7.0}, CellState::kUnknown).fill({1.0, 5.65, 11.0, 5.65}, CellState::kOccupied);
  site.begin_with_what_is_drawn();
  const auto told = site.south(kBox).west(kBox).east(kBox).revision(10.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(sides(told[0].thing.at->assumed), 1);
}

TEST(Assumed, NothingIsWhereTheSettingIsOff) {
  DrawnSite site{{.assumes_sides = false}};
  const auto told = site.south(kBox).west(kBox).revision(10.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(sides(told[0].thing.at->assumed), 0);
}

TEST(Assumed, SidesThatAreSeenAreAssumedNoMore) {
  DrawnSite site;
  site.south(kBox).west(kBox).revision(10.0);
  site.north(kBox).revision(20.0);
  EXPECT_EQ(sides(site.things.all()[0].at->assumed), 1);
  site.east(kBox).revision(30.0);
  const Thing thing = site.things.all()[0];
  EXPECT_EQ(sides(thing.at->seen), 4);
  EXPECT_EQ(sides(thing.at->assumed), 0);
  EXPECT_TRUE(is_closed(*thing.at));
}

TEST(Assumed, ItsCellsAreThoseOfTheBodyThatTheMapDoesNotHave) {
  DrawnSite site;
  site.south(kBox).west(kBox).revision(10.0);
  const std::vector<Cell> cells = assumed_cells(site.things.all(), site.map);
  EXPECT_NEAR(static_cast<double>(cells.size()), 48.0 * 32.0, 100.0);
  for (const Cell cell : cells) {
    EXPECT_EQ(site.map[cell], CellState::kFree) << "the map stays as it was seen";
    EXPECT_TRUE(is_inside(*site.things.all()[0].at, DrawnSite::kGeometry.centre_of(cell), kCells_m));
  }
}

TEST(Assumed, BeamsOfTwoScansThatGoThroughTakeItBackOnce) {
  DrawnSite site;
  site.south(kBox).west(kBox).revision(10.0);
  EXPECT_TRUE(site.things.look(beams_eastward(4.8, 8.0, 11.0)).empty()) << "one pose may be off";
  const auto told = site.things.look(beams_eastward(4.8, 8.0, 12.0));
  ASSERT_EQ(told.size(), 1u);
  EXPECT_FALSE(told[0].is_new);
  EXPECT_EQ(told[0].revision, 1u);
  EXPECT_EQ(told[0].time, DrawnSite::at(12.0));
  EXPECT_EQ(sides(told[0].thing.at->assumed), 0);
  EXPECT_TRUE(site.things.look(beams_eastward(4.8, 8.0, 13.0)).empty());
  EXPECT_TRUE(assumed_cells(site.things.all(), site.map).empty());
  site.fill({6.4, 4.0, 6.4, 4.2}, CellState::kOccupied).revision(20.0);
  EXPECT_EQ(sides(site.things.all()[0].at->assumed), 0) << "not assumed again";
}

TEST(Assumed, BeamsThatEndAtItsFacesOrGoBesideTakeNothingBack) {
  DrawnSite site;
  site.south(kBox).west(kBox).revision(10.0);
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(site.things.look(beams_eastward(4.8, 4.1, 11.0 + i)).empty());
    EXPECT_TRUE(site.things.look(beams_eastward(3.7, 8.0, 11.5 + i)).empty());
  }
  EXPECT_EQ(sides(site.things.all()[0].at->assumed), 2);
}

TEST(Assumed, ARevisionThatFindsTheInsideFreeTakesItBack) {
  DrawnSite site;
  site.fill({4.6, 4.5, 5.8, 5.2}, CellState::kUnknown).begin_with_what_is_drawn();
  site.south(kBox).west(kBox).revision(10.0);
  ASSERT_EQ(sides(site.things.all()[0].at->assumed), 2);
  const auto told = site.fill({4.6, 4.5, 5.8, 5.2}, CellState::kFree).revision(60.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_FALSE(told[0].is_new);
  EXPECT_EQ(sides(told[0].thing.at->assumed), 0);
}

TEST(Assumed, TheSameRevisionsAndScansTellTheSame) {
  const auto run = [] {
    DrawnSite site;
    std::vector<ThingEvent> events = site.south(kBox).west(kBox).revision(10.0);
    for (int i = 0; i < 3; ++i) {
      for (auto& event : site.things.look(beams_eastward(4.8, 8.0, 11.0 + i))) events.push_back(event);
    }
    return std::pair{events, site.things.all()};
  };
  const auto [events, all] = run();
  const auto [events_again, all_again] = run();
  ASSERT_EQ(events.size(), 2u);
  ASSERT_EQ(events_again.size(), 2u);
  for (std::size_t i = 0; i < events.size(); ++i) EXPECT_EQ(events[i].thing, events_again[i].thing);
  EXPECT_EQ(all, all_again);
}

}  // namespace
}  // namespace deltamap::mapping::things
