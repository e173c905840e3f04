// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/seen_space.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/support/scans/surveyed_hall.hpp"

namespace deltamap::surveying::slam {
namespace {

TEST(SeenSpace, IsContradictedByBeamsThroughWallsAndEndsInTheOpen) {
  Random random{6};
  const OccupancyGrid hall = test::drawn_hall(0.05);
  Survey survey;
  survey.component = {0};
  for (const Pose2& pose : test::rounds_of_the_hall(1)) {
    survey.add(keyframe(test::seen_scan(hall, pose, 0.01, random), 0, 0.0));
    survey.poses.back() = pose;
  }
  std::vector<std::uint32_t> first(survey.keyframes.size() / 2);
  std::iota(first.begin(), first.end(), 0U);
  std::vector<std::uint32_t> second(survey.keyframes.size() - first.size());
  std::iota(second.begin(), second.end(), static_cast<std::uint32_t>(first.size()));
  const SeenSpace seen{survey, first, first.front()};
  const std::uint32_t frame = second.front();
  const Pose2 right = motion_between(survey.poses[first.front()], survey.poses[frame]);
  EXPECT_LT(seen.contradicted(survey, second, frame, right), 0.12);
  EXPECT_GT(seen.contradicted(survey, second, frame, right * Pose2{1.0, 0.0, 0.0}), 0.25);
  EXPECT_GT(seen.contradicted(survey, second, frame, right * Pose2{0.0, 0.0, radians(180.0)}), 0.25);
  EXPECT_EQ(seen.contradicted(survey, second, frame, right * Pose2{500.0, 0.0, 0.0}), 1.0) << "nothing was seen there";
}

}  // namespace
}  // namespace deltamap::surveying::slam
