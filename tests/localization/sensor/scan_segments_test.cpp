// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/scan_segments.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace deltamap::localization::sensor {
namespace {

using Segments = std::vector<ScanSegment>;

/// Ends every `step_m` along the x axis.
motion::BeamEnds along_a_wall(std::size_t count, float step_m) {
  motion::BeamEnds ends;
  for (std::size_t i = 0; i < count; ++i) {
    ends.x_m.push_back(step_m * static_cast<float>(i));
    ends.y_m.push_back(3.0F);
  }
  return ends;
}

TEST(ScanSegments, AreNoneWithoutEnds) { EXPECT_TRUE(segmented({}, 1).empty()); }

TEST(ScanSegments, HoldEndsThatLieTogether) { EXPECT_EQ(segmented(along_a_wall(10, 0.1F), 1), (Segments{{0, 10}})); }

TEST(ScanSegments, EndWhereTheNextEndLiesApart) {
  motion::BeamEnds ends = along_a_wall(10, 0.1F);
  for (std::size_t i = 4; i < 10; ++i) ends.y_m[i] += 0.6F;
  EXPECT_EQ(segmented(ends, 1), (Segments{{0, 4}, {4, 10}}));
}

TEST(ScanSegments, EndWhereTheyHaveGrownLong) {
  EXPECT_EQ(segmented(along_a_wall(50, 0.11F), 1), (Segments{{0, 19}, {19, 38}, {38, 50}}));
}

TEST(ScanSegments, LeaveOutThoseOfFewEnds) {
  EXPECT_EQ(segmented(along_a_wall(50, 0.11F), 15), (Segments{{0, 19}, {19, 38}}));
  EXPECT_TRUE(segmented(along_a_wall(4, 1.0F), 2).empty());
}

// ln(1 / 0.1) that it was moved, and ln(0.5 m / σ) that it stands anywhere near.
TEST(ScanSegments, SayAtMostWhatItCostsThatTheirThingWasMoved) {
  const double nats = std::log(10.0) + std::log(10.0);
  const SegmentBound bound = segment_bound({.random_share = 0.15}, 0.05, 1.0);
  EXPECT_EQ(bound.steps, static_cast<std::int32_t>(nats / LikelihoodField::kStep));
  EXPECT_EQ(bound.fewest, 3U) << "two ends say 2 ln(1 / 0.15) = 3.8 nats at most";
  EXPECT_LT(segment_bound({}, 0.1, 1.0).steps, bound.steps);
}

}  // namespace
}  // namespace deltamap::localization::sensor
