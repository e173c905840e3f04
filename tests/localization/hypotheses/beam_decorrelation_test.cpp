// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/beam_decorrelation.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace deltamap::localization::hypotheses {
namespace {

/// Beams that end on a wall 3 m ahead, 10 cm apart from each other.
motion::BeamEnds wall_ahead() {
  motion::BeamEnds ends;
  for (int i = 0; i < 20; ++i) {
    ends.x_m.push_back(3.02F);
    ends.y_m.push_back(0.1F * static_cast<float>(i) - 0.98F);
  }
  return ends;
}

float sum_of(std::span<const float> weights) { return std::accumulate(weights.begin(), weights.end(), 0.0F); }

TEST(BeamDecorrelation, CountsASurfaceLessAtEachLook) {
  BeamDecorrelation novelty;
  const float first = sum_of(novelty.weights(wall_ahead(), {}));
  EXPECT_LE(first, 5.001F) << "of 20: one view may look like another";
  const float second = sum_of(novelty.weights(wall_ahead(), {}));
  const float third = sum_of(novelty.weights(wall_ahead(), {}));
  EXPECT_GT(first, 1.5F * second);
  EXPECT_GT(second, 1.4F * third);
}

TEST(BeamDecorrelation, GivesOneThingLittleMoreThanAFewBeamsHoweverOftenItIsSeen) {
  BeamDecorrelation novelty;
  float all = 0.0F;
  for (int i = 0; i < 100; ++i) all += sum_of(novelty.weights(wall_ahead(), {0.01 * i, 0.0, 0.0}));
  EXPECT_LT(all, 60.0F) << "of 2000 beams";
}

TEST(BeamDecorrelation, KnowsASurfaceAgainFromElsewhere) {
  BeamDecorrelation novelty;
  (void)novelty.weights(wall_ahead(), {});
  motion::BeamEnds nearer = wall_ahead();
  for (float& x_m : nearer.x_m) x_m -= 1.0F;
  const float first = sum_of(novelty.weights(nearer, {5.0, 0.0, 0.0}));
  EXPECT_LT(sum_of(novelty.weights(nearer, {1.0, 0.0, 0.0})), 0.7F * first);
}

TEST(BeamDecorrelation, CountsAnotherSurfaceAndAForgottenOneInFull) {
  BeamDecorrelation novelty;
  const float in_full = sum_of(novelty.weights(wall_ahead(), {}));
  EXPECT_EQ(sum_of(novelty.weights(wall_ahead(), {5.0, 0.0, 0.0})), in_full);
  EXPECT_LT(sum_of(novelty.weights(wall_ahead(), {})), in_full);
  for (int i = 0; i < 200; ++i) (void)novelty.weights(wall_ahead(), {20.0, 0.0, 0.0});
  EXPECT_EQ(sum_of(novelty.weights(wall_ahead(), {})), in_full) << "odometry has drifted since";
  novelty.clear();
  EXPECT_EQ(sum_of(novelty.weights(wall_ahead(), {20.0, 0.0, 0.0})), in_full);
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
