// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/scan_stack.hpp"

#include <gtest/gtest.h>

#include "tests/support/scans/cast_ends.hpp"
#include "tests/support/worlds/drawn_flat.hpp"

namespace deltamap::localization::hypotheses {
namespace {

constexpr double kOfABeam = 0.2;
const Pose2 kTruthAtEnd{7.0, 3.5, 1.0};  // at the newest scan; odometry is exact and in the map's frame
const Pose2 kWrong{1.5, 2.0, -0.7};

/// A metre apart, straight on to the truth.
ScanStack driven_to_the_truth(const OccupancyGrid& world) {
  ScanStack stack;
  Random random{3};
  for (const double back_m : {3.0, 2.0, 1.0, 0.0}) {
    const Pose2 at = kTruthAtEnd * Pose2{-back_m, 0.0, 0.0};
    stack.add(test::cast_ends(world, at, {}, random, 60), at);
  }
  return stack;
}

TEST(ScanStack, SaysNothingForAHypothesisThatTheScansNeverSpeakFor) {
  const OccupancyGrid map = test::drawn_flat();
  const Comparison said =
      driven_to_the_truth(map).compared_lately({map, {}}, kWrong, kTruthAtEnd, kTruthAtEnd, kOfABeam);
  EXPECT_EQ(said.gained, 0.0);
  EXPECT_EQ(said.lost, 0.0);
}

TEST(ScanStack, SaysWhatAHypothesisGainsAndLosesSinceWhenTheScansSpeakForItMost) {
  const OccupancyGrid map = test::drawn_flat();
  const sensor::LikelihoodField field{map, {}};
  const ScanStack stack = driven_to_the_truth(map);
  const Comparison said = stack.compared_lately(field, kTruthAtEnd, kWrong, kTruthAtEnd, kOfABeam);
  const ScanStack::Sums its = stack.log_likelihoods(field, kTruthAtEnd, kTruthAtEnd);
  const ScanStack::Sums others = stack.log_likelihoods(field, kWrong, kTruthAtEnd);
  double most = 0.0;
  for (std::size_t k = 0; k < stack.size(); ++k) most = std::max(most, kOfABeam * (its[k] - others[k]));
  EXPECT_NEAR(said.ahead(), most, 1e-9);
  EXPECT_GT(said.lost, 0.0) << "some beams fit a wrong pose better by chance";
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
