// SPDX-License-Identifier: Apache-2.0
#include "core/grid/tiled.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "core/random.hpp"

namespace deltamap {
namespace {

constexpr int kSide = Tiled<int>::kSide;

Cell any_cell(Random& random, int width, int height) {
  return {static_cast<int>(random.index_below(static_cast<std::uint32_t>(width))),
          static_cast<int>(random.index_below(static_cast<std::uint32_t>(height)))};
}

TEST(Tiled, HoldsWhatWasWrittenAndTheBackgroundElsewhere) {
  Random random{5};
  constexpr int kWidth = 3 * kSide + 7;
  constexpr int kHeight = 2 * kSide + 1;
  Tiled<int> values{kWidth, kHeight, -1};
  std::vector<int> expected(static_cast<std::size_t>(kWidth) * kHeight, -1);
  for (int i = 0; i < 500; ++i) {
    const Cell cell = any_cell(random, kWidth, kHeight);
    values.set(cell, i);
    expected[static_cast<std::size_t>(cell.row * kWidth + cell.column)] = i;
  }
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const Cell cell{column, row};
      ASSERT_EQ(values[cell], expected[static_cast<std::size_t>(row * kWidth + column)]);
      ASSERT_EQ(values.tile_at(cell)[Tiled<int>::slot_of(cell)], values[cell]);
    }
  }
}

TEST(Tiled, CostsWhatHasBeenWrittenHoweverLargeItIs) {
  Tiled<char> values{32767, 32767, 0};
  values.set({20000, 30000}, 0);
  EXPECT_EQ(values.tiles_written(), 0U) << "that changed nothing";
  values.set({20000, 30000}, 1);
  values.set({20001, 30001}, 1);
  EXPECT_EQ(values.tiles_written(), 1U);
}

TEST(Tiled, SharesTilesWithItsCopyUntilOneIsWrittenTo) {
  Tiled<int> first{2 * kSide, kSide, 0};
  const Cell left{1, 1};
  const Cell right{kSide + 1, 1};
  first.set(left, 1);
  first.set(right, 2);
  Tiled<int> second = first;
  EXPECT_EQ(second, first);
  EXPECT_EQ(second.tile_at(left), first.tile_at(left));
  second.set(left, 3);
  EXPECT_NE(second.tile_at(left), first.tile_at(left));
  EXPECT_EQ(second.tile_at(right), first.tile_at(right));
  EXPECT_EQ(first[left], 1);
  EXPECT_EQ(second[left], 3);
  EXPECT_FALSE(second == first);
  const int* const own = second.tile_at(left);
  second.set(left, 1);
  EXPECT_EQ(second.tile_at(left), own) << "nobody else has it";
  EXPECT_EQ(second, first) << "tiles of their own, of the same values";
}

TEST(Tiled, OutlivesTheOneItWasCopiedFrom) {
  Tiled<int> copy;
  {
    Tiled<int> first{kSide, kSide, 7};
    first.set({3, 4}, 8);
    copy = first;
    first = Tiled<int>{1, 1, 0};
  }
  EXPECT_EQ((copy[{3, 4}]), 8);
  EXPECT_EQ((copy[{4, 3}]), 7);
  const Tiled<int> moved = std::move(copy);
  EXPECT_EQ((moved[{3, 4}]), 8);
}

TEST(Tiled, VisitsTheWrittenPartsOfABoxRowByRow) {
  Random random{9};
  constexpr int kWidth = 4 * kSide + 3;
  constexpr int kHeight = 3 * kSide + 5;
  Tiled<int> values{kWidth, kHeight, 0};
  for (int i = 0; i < 5; ++i) values.set(any_cell(random, kWidth, kHeight), 1 + i);
  for (int round = 0; round < 30; ++round) {
    const Cell one = any_cell(random, kWidth, kHeight);
    const Cell other = any_cell(random, kWidth, kHeight);
    const CellBox box{{std::min(one.column, other.column), std::min(one.row, other.row)},
                      {std::max(one.column, other.column) + 1, std::max(one.row, other.row) + 1}};
    Cell last{-1, -1};
    int written = 0;
    values.visit_written(box, [&](Cell first, std::span<const int> piece) {
      EXPECT_TRUE(first.row > last.row || first.column > last.column) << "in order";
      for (std::size_t i = 0; i < piece.size(); ++i) {
        last = {first.column + static_cast<int>(i), first.row};
        ASSERT_TRUE(box.contains(last));
        ASSERT_EQ(piece[i], values[last]);
        written += piece[i] != 0 ? 1 : 0;
      }
    });
    int expected = 0;
    for (int row = box.first.row; row < box.last.row; ++row) {
      for (int column = box.first.column; column < box.last.column; ++column)
        expected += values[{column, row}] != 0 ? 1 : 0;
    }
    EXPECT_EQ(written, expected);
  }
}

TEST(Tiled, VisitsWhatLiesAroundACellInTheGrid) {
  const GridGeometry grid{2 * kSide + 9, kSide + 5, 1.0, {0.0, 0.0}};
  Tiled<int> values{grid.width, grid.height, 0};
  for (std::size_t i = 0; i < grid.cell_count(); ++i) values.set(grid.cell_of(i), static_cast<int>(i));
  for (int row = -4; row < grid.height + 4; ++row) {
    for (int column = -4; column < grid.width + 4; ++column) {
      std::vector<int> around;
      values.visit_around({column, row}, 2, grid, [&](Cell cell, int value) {
        EXPECT_EQ(value, static_cast<int>(grid.index_of(cell)));
        around.push_back(value);
      });
      std::vector<int> expected;
      for (int y = row - 2; y <= row + 2; ++y) {
        for (int x = column - 2; x <= column + 2; ++x) {
          if (grid.contains({x, y})) expected.push_back(static_cast<int>(grid.index_of({x, y})));
        }
      }
      ASSERT_EQ(around, expected) << column << ' ' << row;
    }
  }
}

TEST(Tiled, MayBeCopiedAndWrittenToInSeveralThreadsAtOnce) {
  Tiled<int> first{4 * kSide, kSide, 0};
  for (int column = 0; column < 4 * kSide; ++column) first.set({column, 0}, column);
  std::vector<std::jthread> threads;
  for (int thread = 1; thread <= 3; ++thread) {
    threads.emplace_back([copy = first, thread]() mutable {
      for (int round = 0; round < 200; ++round) {
        Tiled<int> next = copy;
        next.set({round % (4 * kSide), 0}, -thread);
        copy = next;
      }
      for (int column = 0; column < 200; ++column) EXPECT_EQ((copy[{column, 0}]), -thread);
    });
  }
  threads.clear();
  for (int column = 0; column < 4 * kSide; ++column) EXPECT_EQ((first[{column, 0}]), column);
}

}  // namespace
}  // namespace deltamap
