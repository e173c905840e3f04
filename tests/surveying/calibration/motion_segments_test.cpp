// SPDX-License-Identifier: Apache-2.0
#include "surveying/calibration/motion_segments.hpp"

#include <gtest/gtest.h>

#include <cstddef>

namespace deltamap::surveying::calibration {
namespace {

TEST(MotionSegments, EndWhereThePoseIsUnsureOrTheOdometryJumps) {
  MotionSegments segments{{}};
  for (int i = 0; i < 100; ++i) {
    const Pose2 at{0.1 * i, 0.0, 0.0};
    segments.observe({at, i < 50 ? 0u : 1u, at, i % 3 != 2});
  }
  EXPECT_TRUE(segments.segments().empty());
}

TEST(MotionSegments, PredictTheEndThatALeverArmGives) {
  const MotionSegment segment = motion_segment({{1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}}, {2.0, 0.1, 0.05});
  EXPECT_NEAR(segment.disagreement.y(), 0.1, 1e-12);
  // Turned by 1 rad a metre at the middle of each step: 1.5 m and 0.5 m from the end.
  EXPECT_NEAR(segment.by_scale(1, 2), 1.5 + 0.5, 1e-12);
  EXPECT_NEAR(segment.by_scale(0, 0), 2.0, 1e-12);
  // Each step's two turns of deviation 1: levers 2, 1 and 1, 0.
  EXPECT_NEAR(segment.covariance[static_cast<std::size_t>(MotionSource::kTurnPerMetre)](1, 1), 4.0 + 1.0 + 1.0, 1e-12);
}

TEST(MotionSegments, EndAtTheLengthsThatAreAskedInTurn) {
  MotionSegments segments{{.length_m = {0.25, 0.45, 0.25, 0.45}}};
  for (int i = 0; i <= 8; ++i) {
    const Pose2 at{0.1 * i, 0.0, 0.0};
    segments.observe({at, 0, at, true});
  }
  ASSERT_EQ(segments.segments().size(), 2U);
  EXPECT_NEAR(segments.segments()[0].driven_m, 0.3, 1e-9);
  EXPECT_NEAR(segments.segments()[1].driven_m, 0.5, 1e-9);
}

}  // namespace
}  // namespace deltamap::surveying::calibration
