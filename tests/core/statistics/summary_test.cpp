// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/summary.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace deltamap {
namespace {

TEST(Summary, SumsUpValuesAndIsNothingWhereThereAreNone) {
  EXPECT_DOUBLE_EQ(root_mean_square({3.0, -4.0, 0.0, 0.0}), 2.5);
  EXPECT_DOUBLE_EQ(quantile({5.0, 1.0, 4.0, 2.0, 3.0}, 0.8), 4.0);
  EXPECT_DOUBLE_EQ(share_above({0.1, 0.6, 0.5, 0.7}, 0.5), 0.5);
  EXPECT_TRUE(std::isnan(mean_of({})));
}

}  // namespace
}  // namespace deltamap
