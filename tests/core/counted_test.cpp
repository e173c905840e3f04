// SPDX-License-Identifier: Apache-2.0
#include "core/counted.hpp"

#include <gtest/gtest.h>

namespace deltamap {
namespace {

TEST(Counted, NamesOneAsOneAndAllElseAsSeveral) {
  EXPECT_EQ(counted(1, "scan"), "1 scan");
  EXPECT_EQ(counted(0, "scan"), "0 scans");
  EXPECT_EQ(counted(21, "scan"), "21 scans");
  EXPECT_EQ(counted(1, "range is no number", "ranges are no numbers"), "1 range is no number");
  EXPECT_EQ(counted(2, "range is no number", "ranges are no numbers"), "2 ranges are no numbers");
}

}  // namespace
}  // namespace deltamap
