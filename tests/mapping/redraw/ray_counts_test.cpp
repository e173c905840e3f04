// SPDX-License-Identifier: Apache-2.0
// Beams counted over a box of the map, held against a plain walk along each of them.
#include "mapping/redraw/ray_counts.hpp"

#include <gtest/gtest.h>

#include "core/geometry/pose_spread.hpp"
#include "core/grid/grid_ray.hpp"
#include "core/random.hpp"
#include "tests/support/scans/seen_scan.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::mapping::redraw {
namespace {

constexpr double kLongest_m = 6.0;
const GridGeometry kMap{80, 60, 0.1, {-3.0, 1.0}};

TrackedScan random_scan(Random& random) {
  TrackedScan scan;
  for (int i = 0; i < 200; ++i) {
    RayInRobot ray;
    ray.end = {static_cast<float>(random.uniform(-7.0, 7.0)), static_cast<float>(random.uniform(-7.0, 7.0))};
    if (i % 10 == 0) ray.end.x() = 0.0F;
    scan.rays.push_back(ray);
    scan.scan.beams.push_back({ray.end.norm(), 0.0F, i % 7 == 0 ? BeamKind::kNotValid : BeamKind::kRange});
  }
  return scan;
}

OccupancyGrid strewn_walls(Random& random) {
  OccupancyGrid walls{kMap, CellState::kFree};
  for (int i = 0; i < 150; ++i) {
    walls.set({static_cast<int>(random.uniform(0.0, 80.0)), static_cast<int>(random.uniform(0.0, 60.0))},
              CellState::kOccupied);
  }
  return walls;
}

bool is_opaque(Cell cell) { return (cell.column + cell.row) % 2 == 0; }

/// The same over the whole map, cell by cell.
std::vector<RayCount> plain_counts(const PlacedScan& scan, const OccupancyGrid& walls) {
  std::vector<RayCount> counts(kMap.cell_count());
  for (std::size_t i = 0; i < scan.tracked->rays.size(); ++i) {
    if (scan.tracked->scan.beams[i].kind != BeamKind::kRange) continue;
    const Point2 from = scan.map_from_robot.position();
    const Point2 way = scan.map_from_robot * Point2{scan.tracked->rays[i].end.cast<double>()} - from;
    const double length_m = std::min(kLongest_m, way.norm());
    const Point2 end = from + way * (length_m / way.norm());
    bool stopped = false;
    walk_ray(kMap, from, end, [&](Cell cell, double entered_m) {
      if (cell == kMap.cell_at(end)) return false;
      if (!kMap.contains(cell)) return true;
      RayCount& count = counts[kMap.index_of(cell)];
      ++count.passes;
      if (entered_m >= length_m - kClearlyBeyondM) return true;
      ++count.clear_passes;
      stopped = walls[cell] == CellState::kOccupied && is_opaque(cell);
      return !stopped;
    });
    const Cell last = kMap.cell_at(end);
    if (way.norm() <= kLongest_m && !stopped && kMap.contains(last)) ++counts[kMap.index_of(last)].hits;
  }
  return counts;
}

void expect_plain_counts(const PlacedScan& placed, const OccupancyGrid& walls) {
  RayCounts counts{kMap, box_seen(kMap, {&placed, 1}, kLongest_m)};
  counts.stop_at(walls, is_opaque);
  counts.add(placed, kLongest_m);
  const std::vector<RayCount> plain = plain_counts(placed, walls);
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const Cell cell = kMap.cell_of(i);
    if (!counts.box().contains(cell)) {
      EXPECT_EQ(plain[i].seen(), 0);
      continue;
    }
    ASSERT_EQ(counts[cell].hits, plain[i].hits) << cell.column << ' ' << cell.row;
    ASSERT_EQ(counts[cell].passes, plain[i].passes) << cell.column << ' ' << cell.row;
    ASSERT_EQ(counts[cell].clear_passes, plain[i].clear_passes) << cell.column << ' ' << cell.row;
  }
}

TEST(RayCounts, AreThoseOfAPlainWalkAlongEachBeam) {
  Random random{7};
  const OccupancyGrid walls = strewn_walls(random);
  for (int round = 0; round < 20; ++round) {
    const TrackedScan scan = random_scan(random);
    expect_plain_counts({&scan, {random.uniform(-2.5, 4.5), random.uniform(1.5, 6.5), random.uniform(-3.1, 3.1)}},
                        walls);
  }
}

TEST(RayCounts, AreThoseOfAPlainWalkWhereTheLaserIsOutsideTheMapToo) {
  Random random{8};
  const OccupancyGrid walls = strewn_walls(random);
  constexpr double kOutside_m = 0.3;
  const Point2 high = kMap.origin + kMap.resolution_m * Point2{kMap.width, kMap.height};
  const Point2 middle = 0.5 * (kMap.origin + high);
  for (const Point2& place : {Point2{kMap.origin.x() - kOutside_m, middle.y()},
                              {high.x() + kOutside_m, middle.y()},
                              {middle.x(), kMap.origin.y() - kOutside_m},
                              {middle.x(), high.y() + kOutside_m},
                              {high.x() + kOutside_m, high.y() + kOutside_m}}) {
    const TrackedScan scan = random_scan(random);
    expect_plain_counts({&scan, {place.x(), place.y(), random.uniform(-3.1, 3.1)}}, walls);
  }
}

TEST(RayCounts, OfAPartAreThoseOfTheWholeThere) {
  Random random{9};
  const OccupancyGrid walls = strewn_walls(random);
  for (int round = 0; round < 20; ++round) {
    const TrackedScan scan = random_scan(random);
    const PlacedScan placed{&scan, {random.uniform(-2.5, 4.5), random.uniform(1.5, 6.5), random.uniform(-3.1, 3.1)}};
    const Cell first{static_cast<int>(random.uniform(0.0, 70.0)), static_cast<int>(random.uniform(0.0, 50.0))};
    const CellBox part{first, {first.column + 8, first.row + 5}};
    RayCounts counts{kMap, box_seen(kMap, {&placed, 1}, kLongest_m, part)};
    counts.stop_at(walls, is_opaque);
    counts.look_at(part);
    counts.add(placed, kLongest_m);
    const std::vector<RayCount> plain = plain_counts(placed, walls);
    for (int row = part.first.row; row < part.last.row; ++row) {
      for (int column = part.first.column; column < part.last.column; ++column) {
        const RayCount& whole = plain[kMap.index_of({column, row})];
        if (!counts.box().contains({column, row})) {
          EXPECT_EQ(whole.seen(), 0);
          continue;
        }
        EXPECT_EQ((counts[{column, row}].hits), whole.hits);
        EXPECT_EQ((counts[{column, row}].clear_passes), whole.clear_passes);
      }
    }
  }
}

TEST(RayCounts, OfAPartLeaveOutTheBeamsBesideIt) {
  TrackedScan scan;
  scan.rays = {{{0.0F, 0.0F}, {4.0F, 0.0F}}, {{0.0F, 0.0F}, {0.0F, 4.0F}}};
  scan.scan.beams = {{4.0F, 0.0F, BeamKind::kRange}, {4.0F, 0.0F, BeamKind::kRange}};
  const PlacedScan placed{&scan, {-2.95, 1.05, 0.0}};
  const CellBox part{{20, 0}, {25, 1}};  // ahead of the laser
  RayCounts counts{kMap, box_seen(kMap, {&placed, 1}, kLongest_m)};
  counts.look_at(part);
  counts.add(placed, kLongest_m);
  EXPECT_EQ((counts[{22, 0}].passes), 1);
  EXPECT_EQ((counts[{0, 20}].passes), 0);
  EXPECT_EQ(box_seen(kMap, {&placed, 1}, kLongest_m, part).last.row, 1);
}

TEST(RayCounts, CountNothingBehindAnOpaqueCell) {
  const OccupancyGrid world = test::drawn_grid({"...........#"}, 0.1);
  Random random{1};
  TrackedScan scan = test::seen_scan(world, {0.05, 0.05, 0.0}, 0.0, random);
  for (Beam& beam : scan.scan.beams) beam.kind = BeamKind::kNotValid;
  scan.scan.beams[90] = {1.1F, 0.0F, BeamKind::kRange};
  scan.rays[90].end = {1.1F, 0.0F};
  const CellBox all{{0, 0}, {12, 1}};
  RayCounts open{world.geometry(), all};
  open.add({&scan, scan.estimate.map_from_robot}, 20.0);
  EXPECT_GT((open[{11, 0}].hits), 0);
  EXPECT_GT((open[{8, 0}].passes), 0);
  RayCounts shut{world.geometry(), all};
  OccupancyGrid walls = world;
  walls.set({5, 0}, CellState::kOccupied);
  walls.set({3, 0}, CellState::kOccupied);
  shut.stop_at(walls, [](Cell cell) { return cell.column == 5; });
  shut.add({&scan, scan.estimate.map_from_robot}, 20.0);
  EXPECT_EQ((shut[{11, 0}].hits), 0);
  EXPECT_EQ((shut[{8, 0}].passes), 0);
  EXPECT_GT((shut[{5, 0}].passes), 0);
}

}  // namespace
}  // namespace deltamap::mapping::redraw
