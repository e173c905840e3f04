// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/stable_support.hpp"

#include <gtest/gtest.h>

namespace deltamap::localization::belief {
namespace {

TEST(StableSupport, GrowsWithScansThatFitAndFallsWithinASecondOfOthers) {
  StableSupport hold;
  for (int i = 0; i < 50; ++i) hold.observe({.expected = 58, .fit = 55});
  EXPECT_GT(hold.share(), 0.95);
  for (int i = 0; i < 10; ++i) hold.observe({.expected = 58, .fit = 40, .beyond = 18});
  EXPECT_LT(hold.share(), 0.4);
  hold.forget();
  EXPECT_EQ(hold.share(), 0.0);
}

TEST(StableSupport, StaysWhereAThingHasGoneThatHadProven) {
  StableSupport hold;
  for (int i = 0; i < 50; ++i) hold.observe({.expected = 29, .fit = 24, .beyond = 5});
  EXPECT_GT(hold.share(), 0.95);
}

TEST(StableSupport, LearnsNothingFromAFewBeams) {
  StableSupport hold;
  for (int i = 0; i < 50; ++i) hold.observe({.expected = 10, .fit = 10});
  EXPECT_EQ(hold.share(), 0.0);
}

}  // namespace
}  // namespace deltamap::localization::belief
