// SPDX-License-Identifier: Apache-2.0
#include "core/trimmed.hpp"

#include <gtest/gtest.h>

namespace deltamap {
namespace {

TEST(Trimmed, HasNoBlanksAtItsEnds) {
  EXPECT_EQ(trimmed(" \ta  b\r"), "a  b");
  EXPECT_EQ(trimmed("ab"), "ab");
  EXPECT_EQ(trimmed(" \t "), "");
  EXPECT_EQ(trimmed(""), "");
}

}  // namespace
}  // namespace deltamap
