// SPDX-License-Identifier: Apache-2.0
#include "core/ziggurat.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace deltamap {
namespace {

double normal_share_below(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

TEST(Ziggurat, HasTheMomentsOfANormalDistribution) {
  const Ziggurat ziggurat;
  Random random{2};
  constexpr int kCount = 1'000'000;
  std::array<double, 4> moments{};
  for (int i = 0; i < kCount; ++i) {
    const double x = ziggurat.normal(random);
    double power = 1.0;
    for (double& moment : moments) moment += (power *= x) / kCount;
  }
  EXPECT_NEAR(moments[0], 0.0, 0.004);  // four deviations of each mean
  EXPECT_NEAR(moments[1], 1.0, 0.006);
  EXPECT_NEAR(moments[2], 0.0, 0.016);
  EXPECT_NEAR(moments[3], 3.0, 0.04);
}

TEST(Ziggurat, FillsEveryPartOfTheCurveAndItsTails) {
  const Ziggurat ziggurat;
  Random random{3};
  constexpr int kCount = 2'000'000;
  // The layers' borders crowd where the curve is high; 3.44 is where the tail begins.
  const std::array<double, 11> borders{-3.8, -3.4427, -2.5, -1.0, -0.2, 0.0, 0.3, 1.5, 3.0, 3.4427, 3.8};
  std::array<int, 11> below{};
  for (int i = 0; i < kCount; ++i) {
    const double x = ziggurat.normal(random);
    for (std::size_t b = 0; b < borders.size(); ++b) below[b] += x < borders[b] ? 1 : 0;
  }
  for (std::size_t b = 0; b < borders.size(); ++b) {
    const double share = normal_share_below(borders[b]);
    const double deviation = std::sqrt(share * (1.0 - share) / kCount);
    EXPECT_NEAR(static_cast<double>(below[b]) / kCount, share, 4.0 * deviation) << "below " << borders[b];
  }
}

TEST(Ziggurat, RepeatsFromTheGeneratorsSeed) {
  const Ziggurat ziggurat;
  Random a{7};
  Random b{7};
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(ziggurat.normal(a), ziggurat.normal(b));
}

}  // namespace
}  // namespace deltamap
