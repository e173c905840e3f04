// SPDX-License-Identifier: Apache-2.0
// Leaping over clear floor must find what walking finds: held against the plain walk over strewn maps.
#include "mapping/votes/clear_space.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/grid/grid_ray.hpp"
#include "core/random.hpp"
#include "mapping/votes/vote_layer.hpp"

namespace deltamap::mapping::votes {
namespace {

constexpr int kCellsPerBlock = 2;

OccupancyGrid strewn_map(Random& random, int occupied_cells) {
  OccupancyGrid map{{160, 121, 0.05, {-3.0, 2.0}}, CellState::kFree};
  for (int i = 0; i < occupied_cells; ++i) {
    const Cell cell{static_cast<int>(random.uniform(0.0, 160.0)), static_cast<int>(random.uniform(0.0, 121.0))};
    map.set(cell, CellState::kOccupied);
  }
  return map;
}

int distance_by_search(const OccupancyGrid& map, const GridGeometry& blocks, Cell block) {
  int nearest = ClearSpace::kFarthest;
  for (int row = 0; row < map.height(); ++row) {
    for (int column = 0; column < map.width(); ++column) {
      if (map[{column, row}] != CellState::kOccupied) continue;
      nearest = std::min(nearest, std::max(std::abs(column / kCellsPerBlock - block.column),
                                           std::abs(row / kCellsPerBlock - block.row)));
    }
  }
  EXPECT_TRUE(blocks.contains(block));
  return nearest;
}

Point2 anywhere(Random& random) { return {random.uniform(-2.9, 4.9), random.uniform(2.1, 7.9)}; }

TEST(ClearSpace, KnowsTheDistanceToTheNearestSurfaceEverywhere) {
  Random random{3};
  const OccupancyGrid map = strewn_map(random, 12);
  const ClearSpace clear{map, {map.geometry(), kCellsPerBlock}};
  for (std::size_t i = 0; i < clear.blocks().cell_count(); i += 7) {
    const Cell block = clear.blocks().cell_of(i);
    ASSERT_EQ(clear.distance(block), distance_by_search(map, clear.blocks(), block));
  }
}

TEST(ClearSpace, FollowsAMapThatChangesAsIfMadeAnew) {
  Random random{4};
  OccupancyGrid map = strewn_map(random, 30);
  ClearSpace clear{map, {map.geometry(), kCellsPerBlock}};
  for (int round = 0; round < 20; ++round) {
    std::vector<CellChange> changes;
    for (int i = 0; i < 3; ++i) {  // what stands goes, what has gone comes
      const Cell cell{static_cast<int>(random.uniform(0.0, 160.0)), static_cast<int>(random.uniform(0.0, 121.0))};
      const CellState after = map[cell] == CellState::kOccupied ? CellState::kFree : CellState::kOccupied;
      changes.push_back({cell, map[cell], after});
      map.set(cell, after);
    }
    for (int column = 0; column < 160 && round % 2 == 0; ++column) {
      const Cell cell{column, 6 * round};
      if (map[cell] != CellState::kOccupied) continue;
      changes.push_back({cell, CellState::kOccupied, CellState::kFree});
      map.set(cell, CellState::kFree);
    }
    clear.update(map, changes);
    const ClearSpace anew{map, {map.geometry(), kCellsPerBlock}};
    for (std::size_t i = 0; i < clear.blocks().cell_count(); ++i) {
      ASSERT_EQ(clear.distance(clear.blocks().cell_of(i)), anew.distance(clear.blocks().cell_of(i)));
    }
  }
}

TEST(WalkSurfaces, MeetsWhatTheWholeWalkMeets) {
  Random random{5};
  for (int round = 0; round < 1000; ++round) {
    const OccupancyGrid map = strewn_map(random, round / 2);
    const ClearSpace clear{map, {map.geometry(), kCellsPerBlock}};
    const Point2 from = anywhere(random);
    // Straight ones, ones that leave the map, and ones that begin and end in the same place, too.
    Point2 to = round % 5 == 0 ? Point2{anywhere(random).x(), from.y()} : anywhere(random);
    if (round % 7 == 0) to = from + 3.0 * (to - from);
    if (round % 50 == 0) to = from;
    struct Met {
      Cell cell;
      double entered_m;
      double before_m;
    };
    std::vector<Met> by_walking;
    double before_m = 0.0;
    walk_ray(map.geometry(), from, to, [&](Cell cell, double entered_m) {
      if (map.at(cell) == CellState::kOccupied) by_walking.push_back({cell, entered_m, before_m});
      before_m = entered_m;
      return true;
    });
    std::size_t next = 0;
    walk_surfaces(map, clear, from, to, [&](Cell cell, double entered_m, double cell_before_m) {
      EXPECT_LT(next, by_walking.size());
      if (next >= by_walking.size()) return false;
      EXPECT_EQ(cell, by_walking[next].cell);
      EXPECT_NEAR(entered_m, by_walking[next].entered_m, 1e-9);
      EXPECT_NEAR(cell_before_m, by_walking[next].before_m, 1e-9)
          << "round " << round << " cell " << cell.column << "," << cell.row << " entered " << entered_m << " from "
          << from.transpose() << " to " << to.transpose();
      ++next;
      return true;
    });
    ASSERT_EQ(next, by_walking.size()) << "round " << round;
  }
}

TEST(WalkSurfaces, EndsWhereItIsToldTo) {
  OccupancyGrid map{{100, 20, 0.05, {0.0, 0.0}}, CellState::kFree};
  for (const int column : {40, 60, 80}) map.set({column, 10}, CellState::kOccupied);
  int met = 0;
  walk_surfaces(map, ClearSpace{map, {map.geometry(), kCellsPerBlock}}, {0.1, 0.52}, {4.9, 0.52},
                [&](Cell cell, double, double) {
                  ++met;
                  return cell.column < 60;
                });
  EXPECT_EQ(met, 2);
}

TEST(VoteLayer, FindsEveryOpenBlockInABeamsWay) {
  Random random{6};
  const GridGeometry geometry{160, 121, 0.05, {-3.0, 2.0}};
  VoteLayer layer{{.block_m = 0.1}, geometry};
  const auto some_block = [&] {
    return Cell{static_cast<int>(random.uniform(0.0, 80.0)), static_cast<int>(random.uniform(0.0, 60.0))};
  };
  for (int round = 0; round < 300; ++round) {
    layer.vote(Question::kAdded, some_block(), true, 1000);
    layer.vote(Question::kRemoved, some_block(), true, 1000);
    if (round % 3 == 0) layer.reset(Question::kAdded, some_block());
    const Point2 from = anywhere(random);
    const Point2 to = anywhere(random);
    std::vector<Cell> by_walking;
    walk_ray(layer.blocks(), from, to, [&](Cell block, double) {
      if (layer.is_open(Question::kAdded, block)) by_walking.push_back(block);
      return true;
    });
    std::vector<Cell> found;
    layer.walk_open(from, to, [&](Cell block) { found.push_back(block); });
    ASSERT_EQ(found, by_walking);
  }
}

}  // namespace
}  // namespace deltamap::mapping::votes
