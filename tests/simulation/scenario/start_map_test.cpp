// SPDX-License-Identifier: Apache-2.0
#include "simulation/scenario/start_map.hpp"

#include <gtest/gtest.h>

namespace deltamap::simulation {
namespace {

CellState state_at(const OccupancyGrid& map, const Point2& point) { return map.at(map.geometry().cell_at(point)); }

TEST(StartMap, DrawsContoursOccupiedInsidesUnknownAndTheFloorFree) {
  World world{{{1, ObjectKind::kWall, Polyline{{{0, 0}, {10, 0}, {10, 4}, {0, 4}, {0, 0}}}},
               {2, ObjectKind::kContainer, Box{{4, 2}, 1, 1, 0}},
               {3, ObjectKind::kContainer, Box{{5, 2}, 1, 1, 0}},
               {4, ObjectKind::kPost, Circle{{8, 2}, 0.3}}}};
  const OccupancyGrid map = start_map(world, {1, 2}, 0.05);
  EXPECT_EQ(state_at(map, {2, 2}), CellState::kFree);
  EXPECT_EQ(state_at(map, {5, 0}), CellState::kOccupied);
  EXPECT_EQ(state_at(map, {3.5, 2}), CellState::kOccupied);
  EXPECT_EQ(state_at(map, {4, 2}), CellState::kUnknown) << "inside a container";
  EXPECT_EQ(state_at(map, {4.5, 2}), CellState::kUnknown) << "where two containers touch nobody can look";
  EXPECT_EQ(state_at(map, {7.7, 2}), CellState::kOccupied);
  EXPECT_EQ(state_at(map, {8, 2}), CellState::kUnknown) << "inside a post";
  EXPECT_EQ(state_at(map, {-0.5, 2}), CellState::kUnknown) << "behind the wall";
}

TEST(StartMap, PutsRoundCoordinatesIntoTheMiddleOfACell) {
  World world{{{1, ObjectKind::kWall, Polyline{{{0, 0}, {10, 0}, {10, 4}, {0, 4}, {0, 0}}}}}};
  const OccupancyGrid map = start_map(world, {1, 2}, 0.05);
  EXPECT_EQ(state_at(map, {5.01, 0.02}), CellState::kOccupied);
  EXPECT_EQ(state_at(map, {5.01, -0.02}), CellState::kOccupied);
  EXPECT_EQ(state_at(map, {5.01, 0.03}), CellState::kFree);
}

}  // namespace
}  // namespace deltamap::simulation
