// SPDX-License-Identifier: Apache-2.0
#include "core/grid/occupancy_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "core/grid/grid_patch.hpp"
#include "core/random.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap {
namespace {

/// Straight from the definition: byte by byte.
std::uint64_t expected_hash(const OccupancyGrid& grid) {
  std::uint64_t hash = 0xCBF29CE484222325u;
  const auto add = [&](std::uint64_t byte) { hash = (hash ^ byte) * 0x100000001B3u; };
  const auto add_word = [&](std::uint64_t word) {
    for (int shift = 0; shift < 64; shift += 8) add((word >> shift) & 0xFF);
  };
  add_word(static_cast<std::uint64_t>(grid.width()));
  add_word(static_cast<std::uint64_t>(grid.height()));
  for (const double value : {grid.resolution_m(), grid.geometry().origin.x(), grid.geometry().origin.y()})
    add_word(std::bit_cast<std::uint64_t>(value));
  for (std::size_t i = 0; i < grid.geometry().cell_count(); ++i)
    add(static_cast<std::uint64_t>(grid[grid.geometry().cell_of(i)]));
  return hash;
}

OccupancyGrid random_grid(Random& random) {
  const auto side = [&] { return 1 + static_cast<int>(random.index_below(300)); };
  OccupancyGrid grid{{side(), side(), 0.05, {-1.0, 2.0}}, static_cast<CellState>(random.index_below(3))};
  for (std::uint32_t i = random.index_below(50); i > 0; --i) {
    grid.set(grid.geometry().cell_of(random.index_below(static_cast<std::uint32_t>(grid.geometry().cell_count()))),
             static_cast<CellState>(random.index_below(3)));
  }
  return grid;
}

TEST(OccupancyGrid, IsNamedByEachOfItsCellsHoweverFewItStores) {
  Random random{4};
  for (int i = 0; i < 100; ++i) {
    const OccupancyGrid grid = random_grid(random);
    ASSERT_EQ(grid_hash(grid), expected_hash(grid));
  }
}

TEST(OccupancyGrid, KeepsItsNameOverVersionsOfTheProgram) {
  EXPECT_EQ(grid_hash(test::drawn_grid({"#.. ", "... "})), 0x8F0252CCA85975BFU);
}

TEST(OccupancyGrid, CountsAndCopiesAllCells) {
  Random random{6};
  for (int i = 0; i < 50; ++i) {
    const OccupancyGrid grid = random_grid(random);
    const std::vector<CellState> all = all_cells(grid);
    ASSERT_EQ(all.size(), grid.geometry().cell_count());
    for (std::size_t k = 0; k < all.size(); ++k) ASSERT_EQ(all[k], grid[grid.geometry().cell_of(k)]);
    for (const CellState state : {CellState::kFree, CellState::kOccupied, CellState::kUnknown})
      EXPECT_EQ(count_of(grid, state), static_cast<std::size_t>(std::count(all.begin(), all.end(), state)));
  }
}

TEST(OccupancyGrid, EqualsOneOfTheSameCellsWhateverItWasFilledWith) {
  Random random{7};
  for (int i = 0; i < 50; ++i) {
    const OccupancyGrid grid = random_grid(random);
    OccupancyGrid other{grid.geometry(), static_cast<CellState>(random.index_below(3))};
    for (std::size_t k = 0; k < grid.geometry().cell_count(); ++k) {
      const Cell cell = grid.geometry().cell_of(k);
      other.set(cell, grid[cell]);
    }
    EXPECT_EQ(grid, other);
    const Cell corner{grid.width() - 1, grid.height() - 1};
    other.set(corner, grid[corner] == CellState::kFree ? CellState::kOccupied : CellState::kFree);
    EXPECT_FALSE(grid == other);
  }
}

TEST(OccupancyGrid, ShowsWhatIsKnownRowByRow) {
  Random random{8};
  for (int i = 0; i < 50; ++i) {
    const OccupancyGrid grid = random_grid(random);
    std::vector<Cell> known;
    for_each_known(grid, [&](Cell cell, CellState state) {
      EXPECT_EQ(state, grid[cell]);
      known.push_back(cell);
    });
    std::vector<Cell> expected;
    std::vector<CellChange> places;
    for (std::size_t k = 0; k < grid.geometry().cell_count(); ++k) {
      const Cell cell = grid.geometry().cell_of(k);
      if (grid[cell] == CellState::kUnknown) continue;
      expected.push_back(cell);
      places.push_back({.cell = cell});
    }
    ASSERT_EQ(known, expected);
    EXPECT_EQ(known_box(grid), bounding_box(places));
  }
}

TEST(OccupancyGrid, SharesWithItsNextRevisionWhatThatDoesNotChange) {
  OccupancyGrid before{{1000, 1000, 0.05, {0.0, 0.0}}};
  before.set({10, 10}, CellState::kFree);
  before.set({900, 900}, CellState::kFree);
  const CellChange change{{10, 11}, CellState::kUnknown, CellState::kOccupied};
  const OccupancyGrid after = patched(before, std::vector{change});
  EXPECT_EQ(after.tiles().tile_at({900, 900}), before.tiles().tile_at({900, 900}));
  EXPECT_EQ(after.tiles().tiles_written(), 2U);
  EXPECT_EQ(changes_between(before, after), std::vector{change});
}

}  // namespace
}  // namespace deltamap
