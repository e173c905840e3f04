// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/known_ground.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace deltamap::localization::belief {
namespace {

const GridGeometry kMap{200, 100, 0.1, {0.0, 0.0}};
constexpr Cell kKnown{20, 50};
constexpr Cell kDrawn{150, 50};

/// Known up to the middle.
OccupancyGrid half_known() {
  OccupancyGrid map{kMap};
  for (int row = 0; row < kMap.height; ++row) {
    for (int column = 0; column < kMap.width / 2; ++column) map.set({column, row}, CellState::kFree);
  }
  return map;
}

using Beams = std::vector<CheckedBeam>;
Beams facing(Cell cell, BeamFit what, std::size_t east, std::size_t north) {
  Beams beams(east, CheckedBeam{what, cell, {1.0, 0.0}});
  beams.insert(beams.end(), north, CheckedBeam{what, cell, {0.0, 1.0}});
  return beams;
}
Beams operator+(Beams a, const Beams& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

class OnTheWay : public testing::Test {
 protected:
  bool left_after(const Beams& beams, double driven_m) {
    for (double m = 0.0; m < driven_m; m += 0.1) ground_.observe(beams, kMap, 0.1);
    return ground_.is_left();
  }
  KnownGround ground_{half_known()};
};

TEST_F(OnTheWay, IsLeftWhereAllThatFitsWasDrawnSince) {
  EXPECT_FALSE(left_after(facing(kDrawn, BeamFit::kFit, 10, 10), 0.8));
  EXPECT_TRUE(left_after(facing(kDrawn, BeamFit::kFit, 10, 10), 0.8));
}

TEST_F(OnTheWay, IsNotLeftWhereNothingWasDrawn) {
  EXPECT_FALSE(left_after({}, 50.0));
  EXPECT_FALSE(left_after(facing(kKnown, BeamFit::kBeyond, 30, 30), 50.0))
      << "much has changed, all of it known ground";
}

TEST_F(OnTheWay, IsLeftWhereKnownGroundHoldsThePoseInOneDirectionAloneAndLessThanWhatWasDrawn) {
  const Beams wall = facing(kKnown, BeamFit::kFit, 0, 30);
  EXPECT_FALSE(left_after(facing(kDrawn, BeamFit::kFit, 2, 2) + wall, 5.0)) << "a corridor with a patch behind a door";
  EXPECT_TRUE(left_after(facing(kDrawn, BeamFit::kFit, 10, 10) + wall, 2.0));
}

/// A hall in which most has changed would never hold the pose again.
TEST_F(OnTheWay, IsFoundAgainWhereNothingDrawnHasBeenInViewForLong) {
  ASSERT_TRUE(left_after(facing(kDrawn, BeamFit::kFit, 10, 10), 2.0));
  const Beams changed = facing(kKnown, BeamFit::kFit, 5, 5) + facing(kKnown, BeamFit::kBeyond, 20, 20);
  EXPECT_TRUE(left_after(changed, 9.0));
  EXPECT_FALSE(left_after(changed, 2.0));
}

TEST_F(OnTheWay, IsFoundAgainOnceKnownGroundHoldsThePoseForAMetre) {
  ASSERT_TRUE(left_after(facing(kDrawn, BeamFit::kFit, 10, 10), 2.0));
  const Beams drawn = facing(kDrawn, BeamFit::kFit, 10, 10);
  EXPECT_TRUE(left_after(drawn + facing(kKnown, BeamFit::kFit, 5, 5) + facing(kKnown, BeamFit::kBeyond, 8, 8), 5.0))
      << "most of it does not fit";
  EXPECT_TRUE(left_after(drawn + facing(kKnown, BeamFit::kFit, 5, 5), 0.8));
  EXPECT_FALSE(left_after(drawn + facing(kKnown, BeamFit::kFit, 5, 5), 0.8));
}

TEST_F(OnTheWay, IsKnownAtAPoseThatWasGiven) {
  ASSERT_TRUE(left_after(facing(kDrawn, BeamFit::kFit, 10, 10), 2.0));
  ground_.start();
  EXPECT_FALSE(ground_.is_left());
}

TEST_F(OnTheWay, FollowsAMapThatHasGrownBeyondItsBorder) {
  const GridGeometry grown{300, 100, 0.1, {-10.0, 0.0}};
  const Cell known{kKnown.column + 100, kKnown.row};
  ground_.observe(facing(known, BeamFit::kFit, 10, 10) + facing({10, 50}, BeamFit::kFit, 10, 10), grown, 5.0);
  EXPECT_FALSE(ground_.is_left());
}

}  // namespace
}  // namespace deltamap::localization::belief
