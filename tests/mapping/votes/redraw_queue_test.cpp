// SPDX-License-Identifier: Apache-2.0
// When a region that has been written is looked at again.
#include "mapping/votes/redraw_queue.hpp"

#include <gtest/gtest.h>

namespace deltamap::mapping::votes {
namespace {

class Watched : public testing::Test {
 protected:
  /// How many keyframes with these ends there are until the next look; 0: none in a thousand.
  int keyframes_until_look(const std::vector<std::uint32_t>& ends) {
    for (int seen = 1; seen <= 1000; ++seen) {
      queue.see(ends);
      if (queue.due_look()) return seen;
    }
    return 0;
  }

  GridGeometry blocks{20, 10, 0.1, {0.0, 0.0}};
  RedrawQueue queue{{.first_look = 8, .looks = 4}, blocks};
};

TEST_F(Watched, IsLookedAtAgainMuchLaterToo) {
  queue.watch({45, 46}, 0, 0);
  const int first = keyframes_until_look({46});
  const int second = keyframes_until_look({46});
  const int third = keyframes_until_look({46});
  const int fourth = keyframes_until_look({46});
  EXPECT_EQ(first, 8);
  EXPECT_EQ(second, 24);
  EXPECT_EQ(third, 40);
  EXPECT_EQ(fourth, 40);  // as many again: the other side of a wall may be seen much later
}

TEST_F(Watched, IsForgottenAfterItsLooks) {
  queue.watch({45}, 0, 0);
  for (int look = 0; look < 4; ++look) EXPECT_GT(keyframes_until_look({45}), 0);
  EXPECT_EQ(keyframes_until_look({45}), 0);
  EXPECT_FALSE(queue.is_watched(blocks.cell_of(45)));
}

TEST_F(Watched, IsSeenByEndsInItsOwnBlocksAlone) {
  queue.watch({45, 66}, 0, 0);
  EXPECT_EQ(keyframes_until_look({44, 46, 65, 67}), 0);
  EXPECT_EQ(keyframes_until_look({67, 66, 3}), 8);  // in any order
}

TEST_F(Watched, IsEachRegionByItself) {
  queue.watch({45}, 0, 0);
  queue.watch({66}, 0, 0);
  for (int seen = 0; seen < 7; ++seen) queue.see({45});
  queue.see({66});
  EXPECT_FALSE(queue.due_look());
  queue.see({45});
  const auto look = queue.due_look();
  ASSERT_TRUE(look);
  EXPECT_EQ(look->blocks, (std::vector<std::uint32_t>{45}));
}

TEST_F(Watched, IsNotKeptWaitingByWhatHasBeenLookedAtBefore) {
  queue.watch({45}, 0, 0);
  EXPECT_EQ(keyframes_until_look({45}), 8);
  queue.watch({66}, 0, 0);
  for (int seen = 0; seen < 24; ++seen) queue.see({45, 66});
  const auto look = queue.due_look();
  ASSERT_TRUE(look);
  EXPECT_EQ(look->blocks, (std::vector<std::uint32_t>{66}));
}

TEST_F(Watched, BeginsAnewWhereSomethingWent) {
  queue.watch({45, 46}, 0, 1'000);
  queue.watch({66}, 0, 2'000);
  queue.begin_anew({46, 47}, 9'000);
  for (int seen = 0; seen < 8; ++seen) queue.see({45, 66});
  const auto first = queue.due_look();
  const auto second = queue.due_look();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->first_ms, 9'000u);
  EXPECT_EQ(second->first_ms, 2'000u);
}

TEST_F(Watched, IsForgottenWhereWhatCameHasGoneAgain) {
  queue.watch({45, 46}, 0, 0);
  queue.watch({46}, 0, 0);
  queue.forget({46});
  EXPECT_FALSE(queue.is_watched(blocks.cell_of(46)));
  EXPECT_TRUE(queue.is_watched(blocks.cell_of(45)));
  EXPECT_EQ(keyframes_until_look({46}), 0);
  EXPECT_EQ(keyframes_until_look({45}), 8);
}

}  // namespace
}  // namespace deltamap::mapping::votes
