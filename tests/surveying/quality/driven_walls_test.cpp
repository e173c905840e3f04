// SPDX-License-Identifier: Apache-2.0
#include "surveying/quality/driven_walls.hpp"

#include <gtest/gtest.h>

#include "tests/surveying/quality/placed_drive.hpp"

namespace deltamap::surveying::quality {
namespace {

std::vector<Point2> driven(const test::PlacedDrive& drive) {
  const std::vector<Pass> passes = passes_of(drive.placed);
  return driven_walls(drive.placed, passes, SeenWalls{drive.placed, passes});
}

TEST(DrivenWalls, AreNoneAtTruePoses) {
  EXPECT_TRUE(driven(test::PlacedDrive{test::drawn_hall(0.02), test::rounds_of_the_hall(1)}).empty());
}

TEST(DrivenWalls, AreWhereTheWayLeadsThroughOne) {
  const std::vector<Pose2> way = test::rounds_of_the_hall(2);
  test::PlacedDrive drive{test::drawn_hall(0.02), way};
  // The second round, drawn through the containers at y = 8.5 to 10.
  drive.move(way.size() / 2, way.size(), {0.0, 2.4, 0.0});
  EXPECT_FALSE(driven(drive).empty());
}

}  // namespace
}  // namespace deltamap::surveying::quality
