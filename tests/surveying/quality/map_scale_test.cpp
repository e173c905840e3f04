// SPDX-License-Identifier: Apache-2.0
#include "surveying/quality/map_scale.hpp"

#include <gtest/gtest.h>

#include "tests/surveying/quality/placed_drive.hpp"

namespace deltamap::surveying::quality {
namespace {

double error_of(double scale) {
  test::PlacedDrive drive{test::drawn_hall(0.02), test::rounds_of_the_hall(1)};
  for (PlacedScan& scan : drive.placed) {
    scan.map_from_robot.x *= scale;
    scan.map_from_robot.y *= scale;
  }
  const std::vector<Pass> passes = passes_of(drive.placed);
  const MapScale scale_of = map_scale(drive.placed, passes, SeenWalls{drive.placed, passes});
  EXPECT_GT(scale_of.looks, 1000U);
  EXPECT_GT(scale_of.lever_m, 0.5);
  return scale_of.error;
}

TEST(MapScale, IsRightAtTruePoses) { EXPECT_NEAR(error_of(1.0), 0.0, 0.005); }

TEST(MapScale, TellsAWayThatIsTooLongOrTooShort) {
  EXPECT_GT(error_of(1.03), 0.012);
  EXPECT_LT(error_of(0.97), -0.012);
}

}  // namespace
}  // namespace deltamap::surveying::quality
