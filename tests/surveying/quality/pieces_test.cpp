// SPDX-License-Identifier: Apache-2.0
#include "surveying/quality/pieces.hpp"

#include <gtest/gtest.h>

namespace deltamap::surveying::quality {
namespace {

TEST(Pieces, AreHeldTogetherByPassesThatAgree) {
  std::vector<Pass> passes(5);
  for (std::uint32_t i = 0; i < 5; ++i) passes[i] = {i, i, 0, 3.0 * i, 3.0 * i + 3.0, {0.0, 0.0}};
  const std::vector<PassPair> pairs{{.one = 0, .other = 2, .ended = 200, .through = 5},
                                    {.one = 1, .other = 2, .ended = 40, .through = 0},
                                    {.one = 2, .other = 3, .ended = 60, .through = 60},  // contradict
                                    {.one = 3, .other = 4, .ended = 5, .through = 0}};   // nearly nothing in common
  const std::vector<Piece> pieces = pieces_of(passes, pairs);
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_EQ(pieces[0].passes, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_NEAR(pieces[0].way_m, 9.0, 1e-9);
  EXPECT_NEAR(pieces[1].way_m, 3.0, 1e-9);
}

}  // namespace
}  // namespace deltamap::surveying::quality
