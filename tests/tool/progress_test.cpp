// SPDX-License-Identifier: Apache-2.0
#include "tool/progress.hpp"

#include <gtest/gtest.h>

namespace deltamap::tool {
namespace {

TEST(TimeLeft, IsToldInTheUnitThatSuitsIt) {
  EXPECT_EQ(time_left(10.0, 0.2), "40 s left");
  EXPECT_EQ(time_left(60.0, 0.25), "3 min left");
  EXPECT_EQ(time_left(3600.0, 0.2), "4.0 h left");
}

TEST(TimeLeft, IsNotToldBeforeItCanBeNorAtTheEnd) {
  EXPECT_EQ(time_left(1.0, 0.0), "");
  EXPECT_EQ(time_left(1.0, 0.005), "");
  EXPECT_EQ(time_left(100.0, 0.97), "");
  EXPECT_EQ(time_left(100.0, 1.0), "");
}

}  // namespace
}  // namespace deltamap::tool
