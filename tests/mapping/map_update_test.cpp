// SPDX-License-Identifier: Apache-2.0
// Which method answers a set; and the evidence method in a drawn hall: the world changes, the robot drives by, the map
// follows.
#include "mapping/map_update.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "mapping/map_update_params.hpp"
#include "tests/mapping/mapped_drive.hpp"
#include "tests/support/scans/kept_scans.hpp"

namespace deltamap::mapping {
namespace {

double occupied_share(const OccupancyGrid& map, Point2 low, Point2 high) {
  const Cell first = map.geometry().cell_at(low);
  const Cell last = map.geometry().cell_at(high);
  int occupied = 0;
  int all = 0;
  for (int row = first.row; row <= last.row; ++row) {
    for (int column = first.column; column <= last.column; ++column, ++all) {
      occupied += map[{column, row}] == CellState::kOccupied ? 1 : 0;
    }
  }
  return static_cast<double>(occupied) / all;
}

/// Share of the columns between the two corners that have an occupied cell between them.
double drawn_share(const OccupancyGrid& map, Point2 low, Point2 high) {
  int drawn = 0;
  int all = 0;
  for (double x = low.x(); x <= high.x(); x += map.resolution_m(), ++all) {
    drawn += occupied_share(map, {x, low.y()}, {x, high.y()}) > 0.0 ? 1 : 0;
  }
  return static_cast<double>(drawn) / all;
}

const OccupancyGrid kAnyMap{{4, 4, 0.1, {0.0, 0.0}}, CellState::kFree};

/// Two scans and no verdict: too few for the paper's method, nothing to write for the other.
ScanSet two_scans(MappingMethod method) {
  ScanSet set;
  set.method = method;
  set.scans = test::kept({TrackedScan{}, TrackedScan{}});
  return set;
}

TEST(MapUpdate, IsByTheMethodOfTheSet) {
  EXPECT_EQ(map_update(kAnyMap, two_scans(MappingMethod::kPaper), {}).refusal, scan_set::Refusal::kTooFewScans);
  EXPECT_EQ(map_update(kAnyMap, two_scans(MappingMethod::kEvidence), {}).refusal, scan_set::Refusal::kNothingChanged);
}

TEST(MapUpdate, RefusesASetWhosePoseIsInDoubtByEitherMethod) {
  for (const MappingMethod method : {MappingMethod::kPaper, MappingMethod::kEvidence}) {
    ScanSet set = two_scans(method);
    set.pose_in_doubt = true;
    EXPECT_EQ(map_update(kAnyMap, set, {}).refusal, scan_set::Refusal::kPoseInDoubt);
  }
}

TEST(MapUpdate, LeavesAMapAloneThatIsRight) {
  MappedDrive drive{hall()};
  drive.through(always(hall()), 60.0);
  EXPECT_EQ(drive.revisions, 0);
  EXPECT_EQ(*drive.map, hall());
}

TEST(MapUpdate, WritesAContainerThatHasCome) {
  MappedDrive drive{hall()};
  drive.through(always(hall_with({9.0, 8.0}, {11.0, 8.5}, CellState::kOccupied)), 30.0);
  EXPECT_GE(drive.revisions, 1);
  EXPECT_GT(drawn_share(*drive.map, {9.05, 7.97}, {10.95, 8.07}), 0.9);  // its face, give or take a cell
  EXPECT_EQ(occupied_share(*drive.map, {9.0, 7.0}, {11.0, 7.8}), 0.0);
}

TEST(MapUpdate, FreesWhereAContainerHasGone) {
  MappedDrive drive{hall()};
  drive.through(always(hall_with({8.0, 8.5}, {11.0, 10.0}, CellState::kFree)), 40.0);
  EXPECT_GE(drive.revisions, 1);
  EXPECT_LT(occupied_share(*drive.map, {8.2, 8.5}, {10.8, 8.6}), 0.1);  // the face that was seen through
}

TEST(MapUpdate, TakesBackWhatHasComeAndGone) {
  MappedDrive drive{hall()};
  const Point2 low{9.0, 8.0};
  const Point2 high{11.0, 8.5};
  drive.through(always(hall_with(low, high, CellState::kOccupied)), 30.0);
  ASSERT_GT(drawn_share(*drive.map, {9.05, 7.97}, {10.95, 8.07}), 0.9);
  drive.through(always(hall()), 40.0);
  EXPECT_LT(occupied_share(*drive.map, {9.05, 7.9}, {10.95, 8.3}), 0.05);
}

TEST(MapUpdate, DrawsAPersonWhoStandsForMinutesAndFreesHimWithinSeconds) {
  MappedDrive drive{hall()};
  const auto drawn = [&] {
    return count_of(*drive.map, CellState::kOccupied) - count_of(hall(), CellState::kOccupied);
  };
  drive.through(always(hall_with({10.0, 7.5}, {10.35, 7.8}, CellState::kOccupied)), 110.0);
  EXPECT_EQ(drawn(), 0);
  drive.through(always(hall_with({10.0, 7.5}, {10.35, 7.8}, CellState::kOccupied)), 60.0);
  EXPECT_GT(drawn(), 3);
  drive.through(always(hall()), 15.0);
  EXPECT_EQ(drawn(), 0);
}

TEST(MapUpdate, DoesNotErodeWallsWherePosesAreNoisy) {
  MappedDrive drive{hall()};
  drive.noise.position_deviation_m = 0.06;
  drive.noise.heading_deviation_rad = 0.015;
  drive.noise.range_deviation_m = 0.02;
  drive.through(always(hall()), 120.0);
  std::size_t gone = 0;
  for (const CellChange& change : changes_between(hall(), *drive.map))
    gone += change.before == CellState::kOccupied ? 1 : 0;
  EXPECT_EQ(gone, 0u);
}

TEST(MapUpdate, GivesTheSameMapForTheSameScans) {
  const auto run = [] {
    MappedDrive drive{hall()};
    drive.through(always(hall_with({9.0, 8.0}, {11.0, 8.5}, CellState::kOccupied)), 30.0);
    return grid_hash(*drive.map);
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace deltamap::mapping
