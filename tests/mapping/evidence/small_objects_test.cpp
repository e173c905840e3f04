// SPDX-License-Identifier: Apache-2.0
// Small objects that beams show to be gone together, though none of them shows it alone.
#include "mapping/evidence/small_objects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "tests/mapping/seen_room.hpp"

namespace deltamap::mapping::evidence {
namespace {

class Gone : public testing::Test {
 protected:
  void look(const OccupancyGrid& world, const OccupancyGrid& map) { seen = seen_room(world, map); }
  void look(const OccupancyGrid& world, const OccupancyGrid& map, const Pose2& robot) {
    seen = seen_room(world, map, robot);
  }
  /// First the one map, then the other.
  void known(const OccupancyGrid& first, const OccupancyGrid& then) {
    objects.begin(first);
    objects.follow(then, changes_between(first, then));
  }
  std::size_t missed() { return objects.missed(seen.tracked, seen.beams, {}).size(); }

  SmallObjects objects{SmallObjectParams{}};
  SeenRoom seen;
  const OccupancyGrid object = room_with({4.0, 5.0}, {4.1, 5.1});  // four cells, 2 m ahead
  const OccupancyGrid surface = room_with({4.0, 4.0}, {4.1, 6.0});
};

TEST_F(Gone, IsASmallObjectThatBeamsWouldHaveMet) {
  known(room(), object);
  look(room(), object);
  EXPECT_EQ(missed(), 4U);
}

TEST_F(Gone, IsNoSmallObjectThatBeamsMeet) {
  known(room(), object);
  look(object, object);
  EXPECT_EQ(missed(), 0U);
}

TEST_F(Gone, IsNoSmallObjectBesideWhichABeamEnds) {
  known(room(), object);
  look(room_with({4.0, 5.1}, {4.1, 5.2}), object);  // the pose may be so far off
  EXPECT_EQ(missed(), 0U);
}

TEST_F(Gone, IsNoSmallObjectThatFitsBetweenTwoBeams) {
  known(room(), room_with({8.5, 5.0}, {8.55, 5.05}));
  look(room(), room_with({8.5, 5.0}, {8.55, 5.05}));
  EXPECT_EQ(missed(), 0U);
}

TEST_F(Gone, IsASmallObjectFarAwayThatSeveralBeamsHaveGoneThrough) {
  const OccupancyGrid far = room_with({8.5, 5.0}, {8.55, 5.05});
  known(room(), far);
  look(room(), far, {2.0, 5.025, 0.0});
  for (int i = 1; i < SmallObjectParams{}.thin_looks; ++i) EXPECT_EQ(missed(), 0U);
  EXPECT_EQ(missed(), 1U);
  EXPECT_EQ(missed(), 0U);  // and again from the first
}

TEST_F(Gone, IsNoSmallObjectFarAwayThatABeamHasMetInBetween) {
  const OccupancyGrid far = room_with({8.5, 5.0}, {8.55, 5.05});
  const Pose2 ahead{2.0, 5.025, 0.0};
  known(room(), far);
  look(room(), far, ahead);
  for (int i = 1; i < SmallObjectParams{}.thin_looks; ++i) EXPECT_EQ(missed(), 0U);
  look(far, far, ahead);
  EXPECT_EQ(missed(), 0U);
  look(room(), far, ahead);
  EXPECT_EQ(missed(), 0U);
}

TEST_F(Gone, IsNoSmallObjectAtTheEdgeOfTheView) {
  const OccupancyGrid beside = room_with({2.0, 7.0}, {2.1, 7.1});
  known(room(), beside);
  look(room(), beside);
  EXPECT_EQ(missed(), 0U);
}

TEST_F(Gone, IsNothingThinThatTheFirstMapHadAlready) {
  known(object, object);
  look(room(), object);
  EXPECT_EQ(missed(), 0U);
}

TEST_F(Gone, IsNoSurfaceByItsSpecks) {
  known(room(), surface);
  look(room(), surface);
  EXPECT_EQ(missed(), 0U);
}

TEST_F(Gone, IsWhatIsLeftOfASurfaceFromTheChangeOnThatLeavesIt) {
  known(room(), surface);
  objects.follow(object, changes_between(surface, object));
  look(room(), object);
  EXPECT_EQ(missed(), 4U);
}

TEST_F(Gone, IsNoSmallObjectThatHasGrownIntoASurface) {
  known(room(), object);
  objects.follow(surface, changes_between(object, surface));
  look(room(), surface);
  EXPECT_EQ(missed(), 0U);
  EXPECT_FALSE(objects.is_of_small_object(surface.geometry().cell_at({4.02, 5.02})));
}

TEST_F(Gone, IsASmallObjectAsAWhole) {
  known(room(), object);
  const Cell corner = object.geometry().cell_at({4.02, 5.02});
  const std::vector<Cell> wall{object.geometry().cell_at({9.82, 5.0})};
  EXPECT_EQ(objects.whole(std::vector<Cell>{corner}).size(), 4U);
  EXPECT_TRUE(objects.whole(wall).empty());
}

/// By hand: is the group of this cell small, and none of it in a small group of the first map?
bool is_small_and_new(const OccupancyGrid& first, const OccupancyGrid& map, Cell cell, int most_cells) {
  const auto group_of = [&](const OccupancyGrid& grid, Cell start) {
    std::set<std::pair<int, int>> group;
    std::vector<Cell> open{start};
    while (!open.empty()) {
      const Cell next = open.back();
      open.pop_back();
      if (grid.at(next) != CellState::kOccupied || !group.emplace(next.column, next.row).second) continue;
      for (int row = -1; row <= 1; ++row)
        for (int column = -1; column <= 1; ++column) open.push_back({next.column + column, next.row + row});
    }
    return group;
  };
  const auto is_small = [&](const std::set<std::pair<int, int>>& group) {
    std::set<int> rows;
    for (const auto& [column, row] : group) rows.insert(row);
    return !group.empty() && group.rbegin()->first - group.begin()->first < most_cells &&
           *rows.rbegin() - *rows.begin() < most_cells;
  };
  const auto group = group_of(map, cell);
  return is_small(group) && std::none_of(group.begin(), group.end(), [&](const auto& place) {
           return is_small(group_of(first, {place.first, place.second}));
         });
}

TEST_F(Gone, FollowsSmallObjectsThroughAnyChanges) {
  OccupancyGrid first{{60, 40, 0.05, {0.0, 0.0}}, CellState::kFree};
  Random chance{7};
  const auto scatter = [&](OccupancyGrid& map, int strokes) {
    for (int i = 0; i < strokes; ++i) {
      const Cell from{static_cast<int>(chance.index_below(60)), static_cast<int>(chance.index_below(40))};
      const bool level = chance.index_below(2) == 0;
      const CellState state = chance.index_below(2) == 0 ? CellState::kOccupied : CellState::kFree;
      for (int step = 0; step < static_cast<int>(chance.index_below(12)) + 1; ++step) {
        const Cell cell{from.column + (level ? step : 0), from.row + (level ? 0 : step)};
        if (map.geometry().contains(cell)) map.set(cell, state);
      }
    }
  };
  scatter(first, 25);
  objects.begin(first);
  OccupancyGrid map = first;
  for (int change = 0; change < 30; ++change) {
    const OccupancyGrid before = map;
    scatter(map, 6);
    objects.follow(map, changes_between(before, map));
    for (int row = 0; row < 40; ++row) {
      for (int column = 0; column < 60; ++column) {
        const Cell cell{column, row};
        ASSERT_EQ(objects.is_of_small_object(cell), is_small_and_new(first, map, cell, 16))
            << "change " << change << ", cell " << column << ", " << row;
      }
    }
  }
}

}  // namespace
}  // namespace deltamap::mapping::evidence
