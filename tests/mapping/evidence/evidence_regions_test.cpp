// SPDX-License-Identifier: Apache-2.0
#include "mapping/evidence/evidence_regions.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace deltamap::mapping::evidence {
namespace {

using votes::Question;

std::vector<ProvenBlock> added(const std::vector<Cell>& cells) {
  std::vector<ProvenBlock> blocks;
  for (const Cell& cell : cells) blocks.push_back({Question::kAdded, cell, 0});
  return blocks;
}

std::vector<std::size_t> sizes(const std::vector<ProvenBlock>& blocks, int reach_blocks) {
  std::vector<std::size_t> sizes;
  for (const auto& region : connected_regions(blocks, reach_blocks)) sizes.push_back(region.size());
  return sizes;
}

TEST(EvidenceRegions, JoinBlocksWithinReachInRowsAndColumns) {
  const std::vector<ProvenBlock> blocks = added({{0, 0}, {2, -2}, {5, 0}});
  EXPECT_EQ(sizes(blocks, 1), (std::vector<std::size_t>{1, 1, 1}));
  EXPECT_EQ(sizes(blocks, 2), (std::vector<std::size_t>{2, 1}));
  EXPECT_EQ(sizes(blocks, 3), (std::vector<std::size_t>{3}));
}

TEST(EvidenceRegions, JoinAChainWhateverItsOrder) {
  std::vector<ProvenBlock> chain = added({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}});
  do {
    ASSERT_EQ(sizes(chain, 1), (std::vector<std::size_t>{6}));
  } while (std::next_permutation(chain.begin(), chain.end(), [](const ProvenBlock& a, const ProvenBlock& b) {
    return a.block.column < b.block.column;
  }));
}

TEST(EvidenceRegions, AreOfOneQuestionEach) {
  std::vector<ProvenBlock> blocks = added({{0, 0}, {1, 0}, {2, 0}});
  blocks[1].question = Question::kRemoved;
  EXPECT_EQ(sizes(blocks, 1), (std::vector<std::size_t>{1, 1, 1}));
  EXPECT_EQ(sizes(blocks, 2), (std::vector<std::size_t>{2, 1}));
}

TEST(EvidenceRegions, ComeInTheOrderOfTheirFirstMembers) {
  const auto regions = connected_regions(added({{9, 9}, {0, 0}, {9, 8}}), 1);
  ASSERT_EQ(regions.size(), 2u);
  EXPECT_EQ(regions[0].front().block, (Cell{9, 9}));
  EXPECT_EQ(regions[0].back().block, (Cell{9, 8}));
  EXPECT_EQ(regions[1].front().block, (Cell{0, 0}));
  EXPECT_TRUE(connected_regions({}, 1).empty());
}

}  // namespace
}  // namespace deltamap::mapping::evidence
