// SPDX-License-Identifier: Apache-2.0
#include "simulation/movers/beat.hpp"

#include <gtest/gtest.h>

namespace deltamap::simulation {
namespace {

const std::vector<Point2> kFourCorners{{0, 0}, {4, 0}, {4, 4}, {0, 4}};

TEST(Beat, HeadsForAnyCornerButTheOneThatIsWalkedTo) {
  std::vector<Point2> aims;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    Beat beat{kFourCorners, true};
    ASSERT_EQ(beat.aim(), kFourCorners[1]);
    beat.head_for_other(corner);
    aims.push_back(beat.aim());
  }
  EXPECT_EQ(aims, (std::vector<Point2>{kFourCorners[0], kFourCorners[2], kFourCorners[3]}));
}

TEST(Beat, GoesOnFromTheCornerThatItHeadsFor) {
  Beat beat{kFourCorners, true};
  beat.head_for_other(2);
  beat.reach();
  EXPECT_TRUE(beat.aims_at_first());
}

}  // namespace
}  // namespace deltamap::simulation
