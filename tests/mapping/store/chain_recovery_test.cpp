// SPDX-License-Identifier: Apache-2.0
// A chain of steps of which one is damaged: what lies before and behind it tells what it was.
#include "mapping/store/chain_recovery.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "mapping/store/history.hpp"
#include "mapping/store/map_codec.hpp"
#include "tests/support/daemon/stored_maps.hpp"

namespace deltamap::mapping::store {
namespace {

/// M_0 to M_4, of which M_0 and the last are whole.
class ChainRecovery : public testing::Test {
 protected:
  ChainRecovery() {
    parts.geometry = maps.front().geometry();
    parts.steps.push_back({.number = 0, .hash = signed_hash(maps.front()), .is_sure = true, .has_grid = true});
    for (std::uint32_t number = 1; number <= 4; ++number) {
      const MapRevision revision = test::revision_after(maps.back(), number);
      maps.push_back(*revision.map);
      parts.steps.push_back(
          {number, signed_hash(maps.back()), true, number == 4, encoded_changes(revision.changes, parts.geometry)});
    }
    parts.grid = [this](std::size_t i) {
      const ChainStep& step = parts.steps[i];
      return step.has_grid ? std::optional{maps[step.number]} : std::nullopt;
    };
    parts.made = [this](const MadeStep& step, const OccupancyGrid& map) {
      EXPECT_EQ(map, maps[step.number]) << step.number;
      if (step.is_computed) computed.push_back(step.number);
      ++made;
    };
  }

  std::vector<OccupancyGrid> maps{test::first_map()};
  ChainParts parts;
  std::vector<std::uint32_t> computed;
  std::size_t made = 0;
};

TEST_F(ChainRecovery, OfNoStepsLosesNothing) { EXPECT_TRUE(remake_chain({}).empty()); }

TEST_F(ChainRecovery, OfSoundStepsIsEachAsItWas) {
  EXPECT_TRUE(remake_chain(parts).empty());
  EXPECT_EQ(made, 5u);
  EXPECT_TRUE(computed.empty());
}

TEST_F(ChainRecovery, WhatFollowsFromALaterStepIsNotLost) {
  for (const std::size_t i : {2u, 3u}) {
    parts.steps[i].is_sure = false;
    parts.steps[i].changes = {0xFF, 0xFF, 0xFF, 0xFF};
  }
  EXPECT_EQ(remake_chain(parts), std::vector<std::uint32_t>{2});
  EXPECT_EQ(computed, std::vector<std::uint32_t>{3});
}

TEST_F(ChainRecovery, ComputesADamagedStepFromItsNeighbours) {
  parts.steps[2].is_sure = false;
  parts.steps[2].changes = {0xFF, 0xFF, 0xFF, 0xFF};
  EXPECT_TRUE(remake_chain(parts).empty());
  EXPECT_EQ(made, 5u);
  EXPECT_EQ(computed, std::vector<std::uint32_t>{2});
}

TEST_F(ChainRecovery, ComputesAStepOfWhichNothingIsLeft) {
  parts.steps.erase(parts.steps.begin() + 2);
  EXPECT_TRUE(remake_chain(parts).empty());
  EXPECT_EQ(made, 5u);
  EXPECT_EQ(computed, std::vector<std::uint32_t>{2});
}

TEST_F(ChainRecovery, TellsByNumberWhatCannotBeHad) {
  parts.steps.pop_back();  // no whole map behind it
  parts.steps[3].is_sure = false;
  parts.steps[3].changes = {0xFF, 0xFF, 0xFF, 0xFF};
  EXPECT_EQ(remake_chain(parts), std::vector<std::uint32_t>{3});
  EXPECT_EQ(made, 3u);
}

}  // namespace
}  // namespace deltamap::mapping::store
