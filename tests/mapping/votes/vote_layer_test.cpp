// SPDX-License-Identifier: Apache-2.0
#include "mapping/votes/vote_layer.hpp"

#include <gtest/gtest.h>

namespace deltamap::mapping::votes {
namespace {

TEST(VoteLayer, KeepsPlacesApartWhereATileHasHadToGo) {
  VoteLayer layer{{.most_tiles = 1}, GridGeometry{1000, 1000, 0.1, {0.0, 0.0}}};
  const Cell near{5, 5};
  const Cell far{900, 900};
  layer.vote(Question::kAdded, far, true, 1'000);
  layer.vote(Question::kAdded, near, true, 2'000);  // takes the only tile
  EXPECT_EQ(layer.ballot(Question::kAdded, far, 2'000).yes, 0.0F);
  layer.vote(Question::kAdded, far, true, 3'000);
  EXPECT_EQ(layer.ballot(Question::kAdded, near, 3'000).yes, 0.0F);
  EXPECT_EQ(layer.ballot(Question::kAdded, far, 3'000).yes, 1.0F);
}

TEST(VoteLayer, LetsVotesLapseWhereNobodyVotesAnyMore) {
  VoteLayer layer{{.forget_s = 10.0}, GridGeometry{100, 100, 0.1, {0.0, 0.0}}};
  layer.vote(Question::kAdded, {5, 5}, true, 1'000);
  EXPECT_EQ(layer.ballot(Question::kAdded, {5, 5}, 11'000).yes, 1.0F);
  EXPECT_EQ(layer.ballot(Question::kAdded, {5, 5}, 11'001).yes, 0.0F);
}

}  // namespace
}  // namespace deltamap::mapping::votes
