// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/cell_clusters.hpp"

#include <gtest/gtest.h>

#include "mapping/things/thing_cells.hpp"

namespace deltamap::mapping::things {
namespace {

CellChange occupied(int column, int row) { return {{column, row}, CellState::kFree, CellState::kOccupied}; }

TEST(CellClusters, BridgeGapsUpToTheReach) {
  const std::vector<CellChange> changes{occupied(0, 0), occupied(3, 0), occupied(20, 20), occupied(6, 3)};
  const auto clusters = cell_clusters(changes, 3);
  ASSERT_EQ(clusters.size(), 2u);
  EXPECT_EQ(clusters[0].size(), 3u) << "a chain";
  EXPECT_EQ(clusters[1], (std::vector<CellChange>{occupied(20, 20)}));
  EXPECT_EQ(cell_clusters(changes, 2).size(), 4u);
  EXPECT_TRUE(cell_clusters({}, 3).empty());
}

TEST(ThingCells, KeepWhatEachCellWasFirst) {
  ThingCells cells;
  cells.own({-3, 500}, CellState::kUnknown);
  cells.own({40, 480}, CellState::kFree);
  cells.own({40, 480}, CellState::kOccupied);
  EXPECT_EQ(cells.count(), 2u);
  EXPECT_EQ(cells.before({-3, 500}), CellState::kUnknown);
  EXPECT_EQ(cells.before({40, 480}), CellState::kFree);
  EXPECT_EQ(cells.before({0, 0}), std::nullopt);
  EXPECT_TRUE(cells.has_within({38, 478}, 2));
  EXPECT_FALSE(cells.has_within({37, 480}, 2));
  cells.drop({40, 480});
  cells.drop({40, 480});
  EXPECT_EQ(cells.count(), 1u);
}

}  // namespace
}  // namespace deltamap::mapping::things
