// SPDX-License-Identifier: Apache-2.0
#include "mapping/evidence/passing.hpp"

#include <gtest/gtest.h>

namespace deltamap::mapping::evidence {
namespace {

const GridGeometry kMap{100, 100, 0.05, {0.0, 0.0}};
constexpr Cell kFirst{20, 20};  // block of 0.1 m

class Passes : public testing::Test {
 protected:
  /// So many blocks in a row that somebody votes for, from the second 1 on, for so long.
  [[nodiscard]] std::vector<ProvenBlock> voted(votes::Question question, int blocks, std::uint32_t for_s) {
    std::vector<ProvenBlock> region;
    for (int i = 0; i < blocks; ++i) {
      const Cell block{kFirst.column + i, kFirst.row};
      for (std::uint32_t s = 0; s <= for_s; s += 1) votes.vote(question, block, true, 1'000 + 1'000 * s);
      region.push_back({question, block, 2'000});
    }
    now_ms = 1'000 + 1'000 * for_s;
    return region;
  }
  [[nodiscard]] bool is_passing(const std::vector<ProvenBlock>& region) {
    return passing.is_passing(region, {map, votes, now_ms});
  }
  void fill_rows(int first, int last, CellState state) {
    for (int row = first; row < last; ++row)
      for (int column = 0; column < kMap.width; ++column) map.set({column, row}, state);
  }
  void note_flips(const std::vector<ProvenBlock>& region, int times) {
    for (int i = 0; i < times; ++i) {
      const votes::Question question = i % 2 == 0 ? votes::Question::kAdded : votes::Question::kRemoved;
      for (const ProvenBlock& one : region)
        passing.note(static_cast<std::uint32_t>(votes.blocks().index_of(one.block)), question, now_ms);
    }
  }

  OccupancyGrid map{kMap, CellState::kFree};
  votes::VoteLayer votes{{}, kMap};
  Passing passing{{}};
  std::uint32_t now_ms = 0;
};

TEST_F(Passes, ASmallThingThatStandsFreeUntilItHasStoodForLong) {
  EXPECT_TRUE(is_passing(voted(votes::Question::kAdded, 5, 110)));
  EXPECT_FALSE(is_passing(voted(votes::Question::kAdded, 5, 130)));
}

TEST_F(Passes, NothingAsWideAsAContainer) { EXPECT_FALSE(is_passing(voted(votes::Question::kAdded, 11, 5))); }

TEST_F(Passes, NothingBesideASurface) {
  fill_rows(43, 44, CellState::kOccupied);
  EXPECT_FALSE(is_passing(voted(votes::Question::kAdded, 5, 5)));
}

TEST_F(Passes, NoPartOfAFaceWithUnknownGroundBehindIt) {
  fill_rows(42, 100, CellState::kUnknown);
  EXPECT_FALSE(is_passing(voted(votes::Question::kAdded, 5, 5)));
}

TEST_F(Passes, ASmallThingOnKnownFloorWithALittleUnknownBesideIt) {
  fill_rows(45, 46, CellState::kUnknown);
  EXPECT_TRUE(is_passing(voted(votes::Question::kAdded, 5, 5)));
}

TEST_F(Passes, WhatGoesOnTogglingTwiceAsLongEachTime) {
  const std::vector<ProvenBlock> seconds_5 = voted(votes::Question::kRemoved, 5, 5);
  EXPECT_FALSE(is_passing(seconds_5));
  note_flips(seconds_5, 6);
  EXPECT_TRUE(is_passing(seconds_5));
  EXPECT_TRUE(is_passing(voted(votes::Question::kRemoved, 5, 130)));
  EXPECT_FALSE(is_passing(voted(votes::Question::kRemoved, 5, 700)));  // 5 flips: 2.5 past the limit, 679 s
}

}  // namespace
}  // namespace deltamap::mapping::evidence
