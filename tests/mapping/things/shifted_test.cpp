// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/shifted.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/mapping/things/drawn_site.hpp"

namespace deltamap::mapping::things {
namespace {

// A body of 2.4 m × 1.6 m that is shifted by 0.8 m to the east and 0.4 m to the north.
constexpr Drawn kShifted{4.8, 4.4, 7.2, 6.0};

ShiftEnd end_of(const Drawn& box, bool is_whole) {
  const double length_m = box.high_x - box.low_x;
  const double width_m = box.high_y - box.low_y;
  Outline outline{{0.5 * (box.low_x + box.high_x), 0.5 * (box.low_y + box.high_y)}, length_m, width_m, 0.0, {}, {}};
  if (length_m < width_m) {
    std::swap(outline.length_m, outline.width_m);
    outline.heading_rad = std::acos(0.0);
  }
  return {outline, is_whole};
}

class ShiftedBody : public testing::Test {
 protected:
  DrawnSite site;
  std::vector<Point2> freed;
};

TEST_F(ShiftedBody, OfWhichTheNewPlaceHidesAPartStoodAsLargeAsItStands) {
  const ShiftEnd left = end_of({4.0, 4.0, 4.8, 5.6}, false);  // all that is not hidden but a strip
  const auto shifted = shifted_body(end_of(kShifted, true), left, freed, site.map);
  ASSERT_TRUE(shifted);
  expect_outline(shifted->from, kBox);
  expect_outline(shifted->at, kShifted);
}

TEST_F(ShiftedBody, OfWhichAFaceIsSeenStandsAsLargeAsItStood) {
  site.fill({6.4, 4.4, 7.15, 6.0}, CellState::kUnknown);
  const auto shifted = shifted_body(end_of({7.15, 4.4, 7.2, 6.0}, false), end_of(kBox, true), freed,
                                    site.fill(kBox, CellState::kUnknown).next);
  ASSERT_TRUE(shifted);
  expect_outline(shifted->from, kBox);
  expect_outline(shifted->at, kShifted);
}

TEST_F(ShiftedBody, IsNoneWhereNeitherSizeIsKnown) {
  EXPECT_FALSE(shifted_body(end_of(kShifted, false), end_of({4.0, 4.0, 4.8, 5.6}, false), freed, site.map));
}

TEST_F(ShiftedBody, IsNoneWhereFloorWasSeenThatItWouldStandOn) {
  for (double x = 5.2; x < 6.0; x += 0.2) freed.push_back({x, 5.0});
  freed.push_back({5.2, 5.2});
  EXPECT_FALSE(shifted_body(end_of(kShifted, true), end_of(kBox, true), freed, site.map))
      << "it had gone before the other came";
}

TEST_F(ShiftedBody, IsNoneWhereMostOfWhatItLeftWasNotSeenToGo) {
  EXPECT_FALSE(shifted_body(end_of(kShifted, true), end_of({4.0, 4.0, 4.3, 4.3}, false), freed, site.map));
}

TEST_F(ShiftedBody, IsNoneBesideTheFloorWhereAnotherStood) {
  EXPECT_FALSE(shifted_body(end_of({6.45, 4.0, 8.85, 5.6}, true), end_of(kBox, true), freed, site.map));
}

TEST_F(ShiftedBody, IsNoneWhereTheOtherIsLarger) {
  EXPECT_FALSE(shifted_body(end_of(kShifted, true), end_of({3.0, 4.0, 6.4, 5.6}, false), freed, site.map));
}

TEST_F(ShiftedBody, IsOneThingThatMovedHoweverLateItsOldPlaceIsSeen) {
  const Drawn north_east{4.4, 4.8, 6.8, 6.4};
  site.fill(kBox, CellState::kUnknown).box(kBox).begin_with_what_is_drawn();
  site.fill({4.4, 5.65, 6.8, 6.4}, CellState::kUnknown).fill({6.45, 4.8, 6.8, 6.4}, CellState::kUnknown);
  site.fill({6.45, 4.8, 6.8, 4.8}, CellState::kOccupied).fill({4.4, 5.65, 4.4, 6.4}, CellState::kOccupied);
  const auto came = site.east(north_east).north(north_east).revision(10.0);
  ASSERT_EQ(came.size(), 1u);
  const auto went = site.clear({4.0, 4.0, 6.4, 4.75}).clear({4.0, 4.8, 4.35, 5.6}).revision(500.0);
  ASSERT_EQ(went.size(), 1u);
  EXPECT_EQ(went[0].thing.kind, ThingKind::kMoved);
  EXPECT_EQ(went[0].thing.id, came[0].thing.id);
  expect_outline(*went[0].thing.from, kBox);
  expect_outline(*went[0].thing.at, north_east);
}

TEST_F(ShiftedBody, IsNoneWhereAnotherIsPutOnFloorThatWasFree) {
  site.box(kBox).begin_with_what_is_drawn();
  site.clear(kBox).revision(10.0);
  const auto told = site.box(kShifted).fill({4.85, 4.45, 7.15, 5.95}, CellState::kUnknown).revision(500.0);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].thing.kind, ThingKind::kAppeared);
}

}  // namespace
}  // namespace deltamap::mapping::things
