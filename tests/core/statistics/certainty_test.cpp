// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/certainty.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace deltamap {
namespace {

TEST(Certainty, HoldsTheMeanOfRunsThatScatter) {
  std::vector<double> values;
  for (int i = 0; i < 40; ++i) values.push_back(i % 2 == 0 ? 1.0 : 3.0);
  values.push_back(std::nan(""));
  const Certainty mean = certainty_of_mean(values);
  EXPECT_EQ(mean.runs, 40u);
  EXPECT_NEAR(mean.low, 2.0 - 1.96 / std::sqrt(40.0), 0.1) << "as the normal distribution has it";
  EXPECT_NEAR(mean.high, 2.0 + 1.96 / std::sqrt(40.0), 0.1);
  const Certainty again = certainty_of_mean(values);
  EXPECT_EQ(mean.low, again.low) << "the same runs, the same interval";
  EXPECT_FALSE(certainty_of_mean({1.0, 2.0, 3.0, 4.0}).has_interval()) << "too few";
  EXPECT_FALSE(certainty_of_extreme(values).has_interval());
  EXPECT_EQ(certainty_of_extreme(values).runs, 40u);
}

}  // namespace
}  // namespace deltamap
