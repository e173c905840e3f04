// SPDX-License-Identifier: Apache-2.0
#include "mapping/redraw/closed_faces.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <vector>

#include "core/random.hpp"
#include "tests/support/scans/drawn_scan.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping::redraw {
namespace {

constexpr double kLongestBeam_m = 25.0;
constexpr ClosedFacesParams kParams{.longest_m = kLongestBeam_m, .free_passes = 3};
constexpr int kWallRow = 90;
const GridGeometry kField{120, 120, 0.1, {0.0, 0.0}};
const CellBox kAll{{0, 0}, {120, 120}};
const OccupancyGrid kEmptyField{kField, CellState::kFree};

bool anywhere(Cell) { return true; }

/// A wall 8 m ahead of the robot, so far that neighbouring beams leave cells out between them, drawn by the cells in
/// which a beam of one scan has ended.
class DottedWall {
 public:
  DottedWall() : counts{kField, kAll} {
    OccupancyGrid world = kEmptyField;
    test::fill(world, {4.0, 9.0}, {8.0, 9.1}, CellState::kOccupied);
    Random random{1};
    scan_ = test::drawn_scan(world, nullptr, kRobot, 0.0, random, {.range_deviation_m = 0.0});
    for (std::size_t i = 0; i < scan_.rays.size(); ++i) {
      if (scan_.scan.beams[i].kind != BeamKind::kRange) continue;
      draft.set(kField.cell_at(kRobot * Point2{scan_.rays[i].end.cast<double>()}), CellState::kOccupied);
    }
    counts.add(placed(), kLongestBeam_m);
  }

  [[nodiscard]] PlacedScan placed() const { return {&scan_, kRobot}; }
  /// Columns of the wall's middle that are not drawn.
  [[nodiscard]] static std::vector<int> gaps(const OccupancyGrid& map) {
    std::vector<int> gaps;
    for (int column = 45; column < 75; ++column) {
      if (map[{column, kWallRow}] != CellState::kOccupied) gaps.push_back(column);
    }
    return gaps;
  }
  [[nodiscard]] std::vector<int> gaps_after_closing(const std::function<bool(Cell)>& may_be_added) const {
    return gaps(with_closed_faces(draft, counts, {placed()}, kAll, may_be_added, kParams).map());
  }

  MapDraft draft{kEmptyField};
  RayCounts counts;

 private:
  inline static const Pose2 kRobot{6.0, 1.0, 0.5 * std::numbers::pi};
  TrackedScan scan_;
};

TEST(ClosedFaces, DrawWhatLiesBetweenTheEndsOfNeighbouringBeams) {
  const DottedWall wall;
  ASSERT_GE(DottedWall::gaps(wall.draft.map()).size(), 5u);
  EXPECT_TRUE(wall.gaps_after_closing(anywhere).empty());
}

TEST(ClosedFaces, LeaveAGapThatBeamsHaveGoneThrough) {
  DottedWall wall;
  const int gap = DottedWall::gaps(wall.draft.map()).front();
  TrackedScan through;
  for (int i = 0; i < 3; ++i) {
    through.rays.push_back({{0.0F, 0.0F}, {3.0F, 0.0F}});
    through.scan.beams.push_back({3.0F, 0.0F, BeamKind::kRange});
  }
  const Point2 below = kField.centre_of({gap, kWallRow - 15});
  wall.counts.add({&through, {below.x(), below.y(), 0.5 * std::numbers::pi}}, kLongestBeam_m);
  EXPECT_EQ(wall.gaps_after_closing(anywhere), std::vector<int>{gap});
}

TEST(ClosedFaces, LeaveWhatMayNotBeAdded) {
  const DottedWall wall;
  const int gap = DottedWall::gaps(wall.draft.map()).front();
  EXPECT_EQ(wall.gaps_after_closing([&](Cell cell) { return cell.column != gap; }), std::vector<int>{gap});
}

TEST(ClosedFaces, LeaveAWayBetweenTwoWalls) {
  DottedWall wall;
  MapDraft with_a_door = wall.draft;
  for (int column = 55; column < 63; ++column) with_a_door.set({column, kWallRow}, CellState::kFree);
  const OccupancyGrid closed =
      with_closed_faces(with_a_door, wall.counts, {wall.placed()}, kAll, anywhere, kParams).map();
  for (int column = 55; column < 63; ++column) EXPECT_EQ((closed[{column, kWallRow}]), CellState::kFree) << column;
}

}  // namespace
}  // namespace deltamap::mapping::redraw
