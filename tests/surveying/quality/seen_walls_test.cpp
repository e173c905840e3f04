// SPDX-License-Identifier: Apache-2.0
#include "surveying/quality/seen_walls.hpp"

#include <gtest/gtest.h>

#include "tests/surveying/quality/placed_drive.hpp"

namespace deltamap::surveying::quality {
namespace {

TEST(SeenWalls, StandWhereThePassesSawThemAndFaceTheRobot) {
  const test::PlacedDrive drive{test::drawn_hall(0.02), test::way_along({{7.0, 1.0}, {13.0, 1.0}})};
  const std::vector<Pass> passes = passes_of(drive.placed);
  const SeenWalls walls{drive.placed, passes};
  std::size_t seen_by = 0;
  for (double y = -0.15; y < 0.16; y += 0.1) {  // the lower wall stands at y = 0
    for (const SeenWalls::Wall& wall : walls.at(walls.geometry().cell_at({8.45, y}))) {
      ++seen_by;
      EXPECT_GT(wall.normal.y(), 0.95F);
    }
  }
  EXPECT_GE(seen_by, 1U);
  EXPECT_TRUE(walls.at(walls.geometry().cell_at({8.45, 1.0})).empty());
  EXPECT_TRUE(walls.at({-5, 1 << 20}).empty());
}

}  // namespace
}  // namespace deltamap::surveying::quality
