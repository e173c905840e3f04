// SPDX-License-Identifier: Apache-2.0
#include "mapping/bays/bay_floor.hpp"

#include <cmath>

#include "tests/mapping/bays/seen_bays.hpp"

namespace deltamap::mapping::bays {
namespace {

class BayFloorTest : public SeenBays {
 protected:
  void see(BayFloor& floor, const Pose2& from, int looks) {
    for (int i = 0; i < looks; ++i) {
      const TrackedScan tracked = test::seen_scan(world, from, 0.0, random, 30.0);
      floor.look(tracked, 0, tracked.scan.beams.size(), time_ds += 2);
    }
  }
  [[nodiscard]] FloorCounts counts(const BayFloor& floor) const { return floor.counts(time_ds, 100); }

  std::uint32_t time_ds = 1;
};

TEST_F(BayFloorTest, ATurnedBayHasTheSameFloor) {
  BayFloor upright{square(kBay, kSide_m)};
  const Pose2 turned{9.2, 9.2, radians(30.0)};
  Polygon polygon;
  for (const Point2& corner : square({-1.2, -1.2}, kSide_m)) polygon.push_back(turned * corner);
  BayFloor floor{polygon};
  see(upright, kBefore, 5);
  see(floor, kBefore, 5);
  EXPECT_EQ(counts(floor).cells, counts(upright).cells);
  EXPECT_GT(counts(floor).free, 0.9 * counts(floor).cells);
}

TEST_F(BayFloorTest, OfAnAngleOnlyItsOwnFloorCounts) {
  BayFloor angle{{{8.0, 8.0}, {10.4, 8.0}, {10.4, 8.8}, {8.8, 8.8}, {8.8, 10.4}, {8.0, 10.4}}};
  rebuild({{{9.0, 9.0}, {1.3, 1.3}}});  // in its bay
  see(angle, kBefore, 20);
  EXPECT_FALSE(counts(angle).body);
  EXPECT_GT(counts(angle).free, 0.8 * counts(angle).cells);
}

TEST_F(BayFloorTest, WhatIsSmallIsNoBody) {
  BayFloor floor{square(kBay, kSide_m)};
  rebuild({{kBay + Point2{0.8, 0.8}, {0.5, 0.5}}});
  see(floor, kBefore, 100);
  EXPECT_FALSE(counts(floor).body);
  EXPECT_GT(counts(floor).small, 0);
}

TEST_F(BayFloorTest, APalletIsABodyFromItsNarrowSideAndPeopleBesideEachOtherAreNone) {
  BayFloor pallet{square(kBay, kSide_m)};
  rebuild({{kBay + Point2{0.8, 0.6}, {0.8, 1.2}}});
  see(pallet, kBefore, 20);
  EXPECT_TRUE(counts(pallet).body);
  BayFloor people{square(kBay, kSide_m)};
  std::vector<Placed> strips;  // two of 0.5 m
  for (const double middle_m : {0.9, 1.4}) {
    for (double off_m = -0.25; off_m < 0.24; off_m += 0.05) {
      const double half_m = std::sqrt(std::max(0.0, 0.0625 - std::pow(off_m + 0.025, 2)));
      strips.push_back({kBay + Point2{middle_m + off_m, 0.8 - half_m}, {0.05, 2.0 * half_m}});
    }
  }
  rebuild(strips);
  see(people, kBefore, 100);
  EXPECT_FALSE(counts(people).body);
  EXPECT_GT(counts(people).small, 0);
}

TEST_F(BayFloorTest, AFaceWhereTheFloorWasFreeHasRisenUntilItIsTold) {
  BayFloor floor{square(kBay, kSide_m)};
  rebuild({{kBay + Point2{0.6, 1.2}, {1.2, 0.8}}});
  see(floor, kBefore, 20);
  floor.take_as_told();
  rebuild({{kBay + Point2{0.6, 1.05}, {1.2, 0.8}}});  // of a pose that is a little off
  see(floor, kBefore, 20);
  EXPECT_EQ(counts(floor).risen, 0);
  const int free = counts(floor).free;
  EXPECT_EQ(counts(floor).free_since, free);
  rebuild({{kBay, {2.4, 2.4}}});
  see(floor, kBefore, 5);
  EXPECT_GE(counts(floor).risen, 3);
  EXPECT_EQ(counts(floor).free_since, 0) << "what was free before says nothing of now";
  floor.take_as_told();
  EXPECT_EQ(counts(floor).risen, 0);
}

TEST_F(BayFloorTest, ABodyThatGoesTakesItsShadowWithIt) {
  BayFloor floor{square(kBay, kSide_m)};
  rebuild({{kBay, {2.4, 2.4}}});
  see(floor, kBefore, 12);
  rebuild({{{9.2, 5.0}, {4.0, 1.0}}});  // it has gone, and the right half is covered
  see(floor, kBefore, 5);
  EXPECT_LT(counts(floor).shadowed, 0.1 * counts(floor).cells);
}

TEST_F(BayFloorTest, ABodyThatIsSeenThroughAtItsEdgeKeepsItsShadow) {
  BayFloor floor{square(kBay, kSide_m)};
  rebuild({{kBay, {2.4, 2.4}}});
  see(floor, kBefore, 12);
  const int shadowed = counts(floor).shadowed;
  rebuild({{kBay + Point2{0.2, 0.0}, {2.2, 2.4}}});  // of a pose that is a little off
  see(floor, kBefore, 3);
  EXPECT_GT(counts(floor).shadowed, 0.8 * shadowed);
}

TEST_F(BayFloorTest, AFaceOnTheFarRimThatHasGoneIsSeenThrough) {
  const Pose2 behind{9.2, 14.4, radians(-90.0)};
  BayFloor floor{square(kBay, kSide_m)};
  rebuild({{kBay, {2.4, 2.4}}});
  see(floor, kBefore, 12);  // its front lies on the rim
  ASSERT_TRUE(counts(floor).body);
  rebuild({});
  see(floor, behind, 12);
  EXPECT_FALSE(counts(floor).body);
  rebuild({{kBay, {2.4, 2.4}}});
  see(floor, kBefore, 12);
  EXPECT_GT(counts(floor).shadowed, 0.9 * counts(floor).cells) << "behind a front that is a new one";
}

TEST_F(BayFloorTest, ABodyWasSeenWhenABeamLastEndedInIt) {
  BayFloor floor{square(kBay, kSide_m)};
  EXPECT_EQ(floor.body_seen_ds(), 0u);
  rebuild({{kBay + Point2{0.6, 1.2}, {1.2, 0.8}}});
  see(floor, kBefore, 10);
  const std::uint32_t seen_ds = time_ds;
  rebuild({{{6.0, 5.0}, {8.0, 1.0}}});  // covers the bay
  see(floor, kBefore, 5);
  ASSERT_TRUE(counts(floor).body);
  EXPECT_EQ(floor.body_seen_ds(), seen_ds);
}

TEST_F(BayFloorTest, WhatLiesBehindANewFaceIsFreeNoLonger) {
  BayFloor floor{square(kBay, kSide_m)};
  see(floor, kBefore, 5);
  EXPECT_EQ(counts(floor).shadowed, 0);
  rebuild({{kBay, {2.4, 2.4}}});
  see(floor, kBefore, 12);
  EXPECT_EQ(counts(floor).free, 0);
  EXPECT_GT(counts(floor).shadowed, 0.9 * counts(floor).cells);
}

TEST_F(BayFloorTest, IsKnownSinceMostOfItWasSeen) {
  BayFloor floor{square(kBay, kSide_m)};
  see(floor, kBefore, 5);
  const std::uint32_t seen_ds = time_ds;
  time_ds += 20;
  EXPECT_EQ(floor.seen_since_ds(time_ds, 100, 75), seen_ds);
  EXPECT_EQ(floor.seen_since_ds(time_ds, 100, 101), time_ds - 100) << "never so much within the window";
  floor.forget();
  EXPECT_EQ(counts(floor).known(), 0);
}

}  // namespace
}  // namespace deltamap::mapping::bays
