// SPDX-License-Identifier: Apache-2.0
#include "localization/particles/resampling.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.hpp"

namespace deltamap::localization::particles {
namespace {

TEST(EffectiveSampleSize, IsZeroForNoWeights) { EXPECT_EQ(effective_sample_size({}), 0.0); }

TEST(EffectiveSampleSize, IsZeroForOnlyZeroWeights) {
  const std::vector<double> weights(4, 0.0);
  EXPECT_EQ(effective_sample_size(weights), 0.0);
}

TEST(EffectiveSampleSize, IsTheNumberOfEqualWeightsNormalizedOrNot) {
  EXPECT_NEAR(effective_sample_size(std::vector<double>(7, 1.0)), 7.0, 1e-12);
  EXPECT_NEAR(effective_sample_size(std::vector<double>(7, 1.0 / 7.0)), 7.0, 1e-12);
}

TEST(EffectiveSampleSize, IsOneWhereOneParticleHasAllTheWeight) {
  EXPECT_NEAR(effective_sample_size(std::vector<double>{0.0, 1.0, 0.0}), 1.0, 1e-12);
}

TEST(EffectiveSampleSize, FollowsEquation5ForUnevenWeights) {
  EXPECT_NEAR(effective_sample_size(std::vector<double>{0.5, 0.3, 0.2}), 1.0 / 0.38, 1e-12);
}

TEST(LowVarianceChoice, TakesEveryParticleOnceWhereAllWeighTheSame) {
  const std::vector<double> weights(5, 0.2);
  for (const double offset : {0.001, 0.5, 0.999}) {
    EXPECT_EQ(low_variance_choice(weights, 5, offset), (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  }
}

TEST(LowVarianceChoice, NeverMissesAShareByMoreThanOne) {
  Random random{3};
  std::vector<double> weights(20);
  double sum = 0.0;
  for (double& weight : weights) sum += weight = random.uniform();
  for (double& weight : weights) weight /= sum;
  const auto choice = low_variance_choice(weights, 1000, random.uniform());
  ASSERT_EQ(choice.size(), 1000u);
  EXPECT_TRUE(std::is_sorted(choice.begin(), choice.end()));
  for (std::uint32_t i = 0; i < weights.size(); ++i) {
    const auto times = static_cast<double>(std::count(choice.begin(), choice.end(), i));
    EXPECT_NEAR(times, 1000.0 * weights[i], 1.0);
  }
}

TEST(LowVarianceChoice, NeverTakesAParticleWithoutWeight) {
  const auto choice = low_variance_choice(std::vector<double>{0.0, 1.0, 0.0}, 10, 0.3);
  EXPECT_EQ(choice, std::vector<std::uint32_t>(10, 1u));
}

TEST(KldSampleCount, GrowsWithTheCellsThatParticlesFill) {
  EXPECT_EQ(kld_sample_count(0, 0.05, 2.33), 1u);
  EXPECT_EQ(kld_sample_count(1, 0.05, 2.33), 1u);
  EXPECT_LT(kld_sample_count(10, 0.05, 2.33), kld_sample_count(100, 0.05, 2.33));
  // chi-square of 99 degrees of freedom at 0.99 is 134.6 (tables); divided by 2 * 0.05
  EXPECT_NEAR(static_cast<double>(kld_sample_count(100, 0.05, 2.326)), 1346.4, 3.0);
}

}  // namespace
}  // namespace deltamap::localization::particles
