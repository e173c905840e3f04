// SPDX-License-Identifier: Apache-2.0
#include "surveying/quality/map_quality.hpp"

#include <gtest/gtest.h>

#include "mapping/alignment/local_map.hpp"
#include "tests/surveying/quality/placed_drive.hpp"

namespace deltamap::surveying::quality {
namespace {

/// Of the map that the scans draw where they are placed: it always agrees with most of them.
MapQuality quality_of(const std::vector<PlacedScan>& placed) {
  std::vector<Pose2> poses;
  for (const PlacedScan& scan : placed) poses.push_back(scan.map_from_robot);
  TrackedScan unpacked;
  const mapping::alignment::ScanSource scan_at = [&](std::size_t k) -> const TrackedScan& {
    unpacked = placed[k].scan->tracked();
    return unpacked;
  };
  return map_quality(mapping::alignment::local_map(scan_at, poses, {0, 0, 0.05, {0.0, 0.0}}, {.longest_m = 25.0}),
                     placed);
}

bool tells(const MapQuality& quality, Flaw flaw) { return quality.of(flaw).is_beyond_limit; }

class Quality : public testing::Test {
 protected:
  std::vector<Pose2> way = test::rounds_of_the_hall(2);
  test::PlacedDrive drive{test::drawn_hall(0.02), way};
};

TEST_F(Quality, IsGoodAtTruePoses) {
  const MapQuality quality = quality_of(drive.placed);
  EXPECT_FALSE(quality.is_false());
  EXPECT_GT(quality.pairs, 100U);
  EXPECT_GT(quality.fit.explained_share, 0.95);
}

TEST_F(Quality, IsFalseWhereTheSecondRoundIsTurnedAndSaysThatTheLoopIsOpen) {
  const Point2 pivot = way[way.size() / 2].position();
  const Pose2 turn = Pose2{pivot.x(), pivot.y(), radians(6.0)} * Pose2{-pivot.x(), -pivot.y(), 0.0};
  drive.move(way.size() / 2, way.size(), turn);
  const MapQuality quality = quality_of(drive.placed);
  EXPECT_TRUE(quality.is_false());
  EXPECT_TRUE(tells(quality, Flaw::kOpenLoops));
  EXPECT_FALSE(quality.of(Flaw::kOpenLoops).places.empty());
}

TEST_F(Quality, IsFalseWhereOneStretchIsShifted) {
  drive.move(way.size() / 2, way.size() / 2 + 25, {0.5, 0.5, 0.0});
  const MapQuality quality = quality_of(drive.placed);
  EXPECT_TRUE(quality.is_false());
  EXPECT_GT(quality.out_of_place, 0U);
}

TEST_F(Quality, IsFalseWhereTheWayIsThreePercentTooLong) {
  for (PlacedScan& scan : drive.placed) {
    scan.map_from_robot.x *= 1.03;
    scan.map_from_robot.y *= 1.03;
  }
  EXPECT_TRUE(tells(quality_of(drive.placed), Flaw::kWrongScale));
}

TEST_F(Quality, IsGoodWhereAContainerWasMovedBetweenTwoRounds) {
  OccupancyGrid later = test::drawn_hall(0.02);
  test::fill(later, {9.0, 2.0}, {10.2, 4.4}, CellState::kFree);
  test::fill(later, {11.0, 2.0}, {12.2, 4.4}, CellState::kOccupied);
  const std::vector<Pose2> round = test::rounds_of_the_hall(1);
  const test::PlacedDrive second{later, round};
  const test::PlacedDrive first{test::drawn_hall(0.02), round};
  std::vector<PlacedScan> both = first.placed;
  for (PlacedScan scan : second.placed) {
    scan.drive = 1;
    both.push_back(scan);
  }
  EXPECT_FALSE(quality_of(both).is_false());
}

TEST(MapQuality, IsFalseWhereAStretchHangsOnTheWheels) {
  // Two rooms, and between them a way on which nothing is seen.
  OccupancyGrid far{{2500, 300, 0.02, {-1.0, -3.0}}, CellState::kFree};
  for (const double x : {0.0, 40.0}) {
    test::fill(far, {x, 1.5}, {x + 7.0, 1.6}, CellState::kOccupied);
    test::fill(far, {x, -1.6}, {x + 7.0, -1.5}, CellState::kOccupied);
  }
  Random random{3};
  const std::vector<Pose2> way = test::way_along({{0.5, 0.0}, {46.5, 0.0}});
  std::vector<localization::motion::PackedScan> scans;
  for (const TrackedScan& seen : test::surveyed(far, way, random, 8.0)) scans.emplace_back(seen.scan);
  std::vector<PlacedScan> placed;
  for (std::size_t i = 0; i < way.size(); ++i) placed.push_back({&scans[i], way[i], 0});
  const MapQuality quality = quality_of(placed);
  EXPECT_TRUE(tells(quality, Flaw::kLooseWay));
  EXPECT_GT(quality.loose_m, 20.0);
}

}  // namespace
}  // namespace deltamap::surveying::quality
