// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/cell_clusters.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace deltamap::mapping::things
