// SPDX-License-Identifier: Apache-2.0
#include "core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace deltamap {
namespace {

TEST(Random, RepeatsFromItsSeedAndDiffersBetweenSeeds) {
  Random a{7};
  Random b{7};
  Random c{8};
  const auto first = a();
  EXPECT_EQ(first, b());
  EXPECT_NE(first, c());
}

TEST(Random, StaysUniformInTheHalfOpenInterval) {
  Random random{1};
  double sum = 0.0;
  constexpr int kCount = 100'000;
  for (int i = 0; i < kCount; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    ASSERT_LT(random.index_below(6), 6u);
  }
  EXPECT_NEAR(sum / kCount, 0.5, 0.005);
}

TEST(Random, HasNormalMomentsAndTails) {
  Random random{2};
  double sum = 0.0;
  double squares = 0.0;
  int beyond_two = 0;
  constexpr int kCount = 200'000;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.normal();
    sum += x;
    squares += x * x;
    beyond_two += std::abs(x) > 2.0 ? 1 : 0;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.01);
  EXPECT_NEAR(squares / kCount, 1.0, 0.02);
  EXPECT_NEAR(static_cast<double>(beyond_two) / kCount, 0.0455, 0.003);
}

}  // namespace
}  // namespace deltamap
