// SPDX-License-Identifier: Apache-2.0
#include "daemon/steps/thing_looks.hpp"

#include <gtest/gtest.h>

namespace deltamap::daemon {
namespace {

TEST(ThingLooks, TakesTwoScansASecondOfAPoseThatHolds) {
  ThingLooks looks;
  int taken = 0;
  for (int i = 0; i < 100; ++i) {
    TrackedScan tracked;
    tracked.scan.time = timestamp_from_ns(100'000'000LL * i);
    taken += looks.is_due(tracked, true) ? 1 : 0;
  }
  EXPECT_EQ(taken, 20);
}

TEST(ThingLooks, ThePoseThatDoesNotHoldShowsNothing) {
  ThingLooks looks;
  TrackedScan tracked;
  EXPECT_FALSE(looks.is_due(tracked, false));
  EXPECT_TRUE(looks.is_due(tracked, true)) << "nor is its scan the last one";
}

}  // namespace
}  // namespace deltamap::daemon
