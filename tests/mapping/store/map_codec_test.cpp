// SPDX-License-Identifier: Apache-2.0
#include "mapping/store/map_codec.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <vector>

#include "core/random.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::mapping::store {
namespace {

TEST(MapCodec, GivesGridsAndChangesBack) {
  const OccupancyGrid before = test::drawn_grid({"##..  ", "#.. ##", "......"});
  const OccupancyGrid after = test::drawn_grid({"#.....", "#..###", ".....#"});
  EXPECT_EQ(decoded_grid(encoded_grid(after), after.geometry()), after);
  const auto changes = changes_between(before, after);
  EXPECT_EQ(decoded_changes(encoded_changes(changes, before.geometry()), before.geometry()), changes);
  EXPECT_TRUE(encoded_changes({}, before.geometry()).empty());
}

/// Straight from the definition: the length of each run of equal cells, and their state.
std::vector<std::uint64_t> runs_of(const OccupancyGrid& grid) {
  std::vector<std::uint64_t> runs;
  CellState last = CellState::kFree;
  for (const CellState state : all_cells(grid)) {
    if (runs.empty() || state != last) runs.push_back(static_cast<std::uint64_t>(state));
    last = state;
    runs.back() += 4;
  }
  return runs;
}

TEST(MapCodec, WritesTheSameRunsHoweverFewCellsAGridStores) {
  Random random{12};
  for (int round = 0; round < 30; ++round) {
    const int width = 1 + static_cast<int>(random.index_below(400));
    const int height = 1 + static_cast<int>(random.index_below(200));
    OccupancyGrid grid{{width, height, 0.05, {0.0, 0.0}}, static_cast<CellState>(random.index_below(3))};
    for (std::uint32_t i = random.index_below(20); i > 0; --i) {
      const std::uint32_t cells = static_cast<std::uint32_t>(grid.geometry().cell_count());
      grid.set(grid.geometry().cell_of(random.index_below(cells)), static_cast<CellState>(random.index_below(3)));
    }
    std::vector<std::uint8_t> expected;
    for (std::uint64_t run : runs_of(grid)) {
      for (; run >= 0x80; run >>= 7) expected.push_back(static_cast<std::uint8_t>(run | 0x80));
      expected.push_back(static_cast<std::uint8_t>(run));
    }
    ASSERT_EQ(encoded_grid(grid), expected);
    ASSERT_EQ(decoded_grid(expected, grid.geometry()), grid);
  }
}

TEST(MapCodec, RefusesEveryCutOfAGrid) {
  const OccupancyGrid grid = test::drawn_grid({"##..  ", "#.. ##", "......"});
  const auto bytes = encoded_grid(grid);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(decoded_grid(std::span{bytes}.first(size), grid.geometry())) << size;
  }
}

TEST(MapCodec, RefusesCellsOutsideOfTheMap) {
  const GridGeometry small{4, 4, 0.1, {0.0, 0.0}};
  const GridGeometry large{40, 40, 0.1, {0.0, 0.0}};
  const std::vector<CellChange> changes{{{30, 30}, CellState::kFree, CellState::kOccupied}};
  EXPECT_FALSE(decoded_changes(encoded_changes(changes, large), small));
}

}  // namespace
}  // namespace deltamap::mapping::store
