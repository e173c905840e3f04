// SPDX-License-Identifier: Apache-2.0
#include "navigation/mapped_walls.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "core/geometry/angle.hpp"

namespace deltamap::navigation {
namespace {

/// A hall of 40 m by 40 m, seen by 8 m of laser from 4 m before one of its walls, which is to the left.
TrackedScan beside_a_wall() {
  OccupancyGrid map{{400, 400, 0.1, {0.0, 0.0}}, CellState::kFree};
  for (int x = 0; x < 400; ++x) map.set(Cell{x, 240}, CellState::kOccupied);
  TrackedScan tracked;
  tracked.estimate.map = std::make_shared<const OccupancyGrid>(std::move(map));
  tracked.estimate.map_from_robot = {20.0, 20.0, 0.0};
  tracked.estimate.state = LocalizerState::kTracking;
  tracked.scan.first_bearing_rad = radians(-90.0);
  tracked.scan.bearing_step_rad = radians(1.0);
  tracked.scan.max_range_m = 8.0;
  tracked.scan.beams.assign(181, Beam{0.0F, 0.0F, BeamKind::kBeyondMaximum});
  for (std::size_t i = 124; i < 181; ++i) tracked.scan.beams[i] = {5.0F, 0.0F, BeamKind::kRange};
  return tracked;
}

void lose(TrackedScan& tracked, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) tracked.scan.beams[i].kind = BeamKind::kBeyondMaximum;
}

TEST(MappedWalls, LeaveBeamsWithoutARangeWhereTheMapHasNothingWithinReach) {
  EXPECT_TRUE(expects_no_range(beside_a_wall()));
  TrackedScan covered = beside_a_wall();
  lose(covered, 140, 170);
  EXPECT_FALSE(expects_no_range(covered)) << "the wall should be seen there";
  TrackedScan with_a_gap = beside_a_wall();
  lose(with_a_gap, 150, 160);
  EXPECT_TRUE(expects_no_range(with_a_gap)) << "as little as a sector may be left without that is open again";
  TrackedScan lost = beside_a_wall();
  lost.estimate.state = LocalizerState::kLost;
  EXPECT_FALSE(expects_no_range(lost));
}

TEST(MappedWalls, ExcuseAnEmptyScanOnlyWhereThereIsNoneAtAll) {
  TrackedScan empty = beside_a_wall();
  lose(empty, 0, 181);
  EXPECT_FALSE(expects_no_range(empty));
  empty.estimate.map_from_robot.y = 10.0;
  EXPECT_TRUE(expects_no_range(empty));
  empty.estimate.map =
      std::make_shared<const OccupancyGrid>(GridGeometry{400, 400, 0.1, {0.0, 0.0}}, CellState::kUnknown);
  EXPECT_FALSE(expects_no_range(empty)) << "the map does not know";
}

}  // namespace
}  // namespace deltamap::navigation
