// SPDX-License-Identifier: Apache-2.0
// Scans brought onto the map they were taken in, from a pose that is a little off.
#include "mapping/redraw/placed_scans.hpp"

#include <gtest/gtest.h>

#include "tests/support/scans/drawn_scan.hpp"
#include "tests/support/scans/kept_scans.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping::redraw {
namespace {

/// 24 × 24 m, its walls on the border of the grid: one alone is in reach of a beam.
OccupancyGrid room_without_margin() {
  OccupancyGrid room{{240, 240, 0.1, {0.0, 0.0}}, CellState::kOccupied};
  test::fill(room, {0.1, 0.1}, {23.9, 23.9}, CellState::kFree);
  return room;
}

TEST(PlacedScans, ComeOntoAWallOnTheBorderOfTheMapFromAPoseTooNearToIt) {
  constexpr double kOff_m = 0.1;
  const auto room = std::make_shared<const OccupancyGrid>(room_without_margin());
  for (const double heading_rad : {0.0, 0.5 * std::numbers::pi, std::numbers::pi, -0.5 * std::numbers::pi}) {
    const Point2 ahead{std::cos(heading_rad), std::sin(heading_rad)};
    const Point2 place = Point2{12.0, 12.0} + 9.0 * ahead;
    Random random{4};
    TrackedScan tracked =
        test::drawn_scan(*room, room, {place.x(), place.y(), heading_rad}, 0.0, random, {.range_deviation_m = 0.0});
    tracked.estimate.map_from_robot.x += kOff_m * ahead.x();
    tracked.estimate.map_from_robot.y += kOff_m * ahead.y();
    const Placement placement = placed_scans(*room, test::kept({tracked}), [](Cell) { return false; }, {});
    ASSERT_EQ(placement.scans.size(), 1U);
    const Point2 moved = placement.scans.front().map_from_robot.position() - tracked.estimate.map_from_robot.position();
    EXPECT_LT(moved.dot(ahead), -0.6 * kOff_m) << "heading " << heading_rad;
  }
}

}  // namespace
}  // namespace deltamap::mapping::redraw
