// SPDX-License-Identifier: Apache-2.0
// Eq. 2 and 3 by hand.
#include "mapping/paper/divergence_ratio.hpp"

#include <gtest/gtest.h>

namespace deltamap::mapping::paper {
namespace {

constexpr double kExact = 1e-12;

Estimate weighed(double w_avg, LocalizerState state = LocalizerState::kTracking) {
  Estimate estimate;
  estimate.w_avg = w_avg;
  estimate.state = state;
  return estimate;
}

TEST(DivergenceRatio, StartsBothAveragesAtTheFirstWeight) {
  DivergenceRatio ratio{{.alpha_slow = 0.01, .alpha_fast = 0.1}};
  const WeightAverages& averages = ratio.observe(weighed(0.8));
  EXPECT_EQ(averages.divergence_ratio(), 0.0);
  EXPECT_EQ(averages.w_fast, 0.8);
  EXPECT_EQ(averages.w_slow, 0.8);
}

TEST(DivergenceRatio, FollowsEquationsTwoAndThree) {
  DivergenceRatio ratio{{.alpha_slow = 0.01, .alpha_fast = 0.1}};
  (void)ratio.observe(weighed(0.8));
  // 0.8 - 0.1 · 0.4 and 0.8 - 0.01 · 0.4
  EXPECT_NEAR(ratio.observe(weighed(0.4)).divergence_ratio(), 1.0 - 0.76 / 0.796, kExact);
  EXPECT_NEAR(ratio.observe(weighed(0.9)).divergence_ratio(), 1.0 - (0.76 + 0.1 * 0.14) / (0.796 + 0.01 * 0.104),
              kExact);
}

TEST(DivergenceRatio, IsNegativeWhereScansFitBetterThanTheyUsedTo) {
  DivergenceRatio ratio{{}};
  (void)ratio.observe(weighed(0.4));
  EXPECT_LT(ratio.observe(weighed(0.8)).divergence_ratio(), 0.0);
}

TEST(DivergenceRatio, CountsNoScanOfALostPose) {
  DivergenceRatio ratio{{}};
  EXPECT_EQ(ratio.observe(weighed(0.2, LocalizerState::kLost)).divergence_ratio(), 0.0);
  EXPECT_EQ(ratio.observe(weighed(0.8)).w_slow, 0.8);
  EXPECT_EQ(ratio.observe(weighed(0.2, LocalizerState::kGlobal)).w_fast, 0.8);
}

}  // namespace
}  // namespace deltamap::mapping::paper
