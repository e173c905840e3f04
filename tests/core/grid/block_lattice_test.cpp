// SPDX-License-Identifier: Apache-2.0
#include "core/grid/block_lattice.hpp"

#include <gtest/gtest.h>

namespace deltamap {
namespace {

constexpr double kCell_m = 0.05;

/// A map whose first cell is that many cells of the frame's away from its origin.
GridGeometry map_from(int column, int row) { return {50, 40, kCell_m, {column * kCell_m, row * kCell_m}}; }

TEST(BlockLattice, BeginsAtTheMapsCornerWhereThatIsABlocks) {
  const BlockLattice lattice{map_from(-10, 20), 5};
  EXPECT_EQ(lattice.ahead(), (Cell{0, 0}));
  EXPECT_EQ(lattice.blocks(), (GridGeometry{10, 8, 5 * kCell_m, {-10 * kCell_m, 20 * kCell_m}}));
  EXPECT_EQ(lattice.block_of({4, 5}), (Cell{0, 1}));
  EXPECT_EQ(lattice.cells_of({1, 1}), (CellBox{{5, 5}, {10, 10}}));
}

TEST(BlockLattice, PutsTheSameCellsTogetherHoweverMuchLiesAroundThem) {
  for (const Point2& frame : {Point2{0.0, 0.0}, Point2{0.013, -0.021}, Point2{0.025, 0.025}}) {
    GridGeometry small = map_from(-340, 7);
    small.origin += frame;
    for (int around = 1; around < 200; around += 13) {
      GridGeometry large{50 + 2 * around, 40 + 2 * around, kCell_m, small.origin - Point2::Constant(around * kCell_m)};
      for (const int side : {1, 2, 3, 5, 8}) {
        const BlockLattice of_small{small, side};
        const BlockLattice of_large{large, side};
        for (int column = 0; column + 1 < small.width; ++column) {
          const auto are_together = [&](const BlockLattice& lattice, int at) {
            return lattice.block_of({at, 0}).column == lattice.block_of({at + 1, 0}).column;
          };
          ASSERT_EQ(are_together(of_small, column), are_together(of_large, column + around)) << side << ' ' << around;
        }
      }
    }
  }
}

TEST(BlockLattice, FindsEachCellInItsOwnBlock) {
  for (int from = -7; from <= 7; ++from) {
    const BlockLattice lattice{map_from(from, -from), 4};
    for (int row = 0; row < 40; ++row) {
      for (int column = 0; column < 50; ++column) {
        const Cell block = lattice.block_of({column, row});
        ASSERT_TRUE(lattice.blocks().contains(block));
        ASSERT_TRUE(lattice.cells_of(block).contains({column, row}));
        ASSERT_EQ(lattice.blocks().cell_at(map_from(from, -from).centre_of({column, row})), block);
        ASSERT_EQ(lattice.blocks_of({{column, row}, {column + 1, row + 1}}).first, block);
      }
    }
    const CellBox around = lattice.blocks_of({{-9, -9}, {1, 1}});
    EXPECT_TRUE(lattice.cells_of(around.first).contains({-9, -9}));
    EXPECT_EQ(around.last, (Cell{lattice.block_of({0, 0}).column + 1, lattice.block_of({0, 0}).row + 1}));
  }
}

}  // namespace
}  // namespace deltamap
