// SPDX-License-Identifier: Apache-2.0
// Which blocks toggle, and which are only written again now and then.
#include "mapping/votes/flip_memory.hpp"

#include <gtest/gtest.h>

namespace deltamap::mapping::votes {
namespace {

TEST(FlipMemory, CallsTogglingWhatIsWrittenBackAndForth) {
  FlipMemory memory{{}};
  memory.note(7, Question::kAdded, 1'000);
  memory.note(7, Question::kRemoved, 121'000);
  EXPECT_LT(memory.beyond(7, 121'000), 0.0);
  memory.note(7, Question::kAdded, 241'000);
  EXPECT_LT(memory.beyond(7, 241'000), 0.0);  // a slot that was emptied and filled, once more
  memory.note(7, Question::kRemoved, 361'000);
  EXPECT_GE(memory.beyond(7, 361'000), 0.0);
  EXPECT_LT(memory.beyond(8, 361'000), 0.0);
}

TEST(FlipMemory, ForgetsInTime) {
  FlipMemory memory{{}};
  for (std::uint32_t i = 0; i < 6; ++i) memory.note(7, i % 2 == 0 ? Question::kAdded : Question::kRemoved, 1'000 * i);
  EXPECT_GE(memory.beyond(7, 6'000), 0.0);
  EXPECT_LT(memory.beyond(7, 6'000 + 4 * 3'600'000), 0.0);
}

TEST(FlipMemory, AContainerASlotAnHourIsNoToggling) {
  FlipMemory memory{{}};
  for (std::uint32_t hour = 0; hour < 10; ++hour) {
    memory.note(7, hour % 2 == 0 ? Question::kAdded : Question::kRemoved, 3'600'000 * hour);
    EXPECT_LT(memory.beyond(7, 3'600'000 * hour), 0.0);
  }
}

}  // namespace
}  // namespace deltamap::mapping::votes
