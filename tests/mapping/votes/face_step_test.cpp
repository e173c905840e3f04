// SPDX-License-Identifier: Apache-2.0
#include "mapping/votes/face_step.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/geometry/angle.hpp"

namespace deltamap::mapping::votes {
namespace {

std::vector<std::size_t> face_steps(const std::vector<Point2>& ends) {
  std::vector<std::size_t> steps;
  for_each_face_step(
      ends.size(), radians(1.0), [&](std::size_t i) { return ends[i].norm(); },
      [&](std::size_t i) -> const Point2& { return ends[i]; }, [&](std::size_t i) { steps.push_back(i); });
  return steps;
}

TEST(FaceStep, JoinsTheMiddleOfAStraightFace) {
  EXPECT_EQ(face_steps({{10.0, 0.0}, {10.0, 0.2}, {10.0, 0.4}, {10.0, 0.6}, {10.0, 0.8}}),
            (std::vector<std::size_t>{1, 2}));
}

TEST(FaceStep, CutsNoCorner) {
  EXPECT_TRUE(face_steps({{10.0, 0.0}, {10.0, 0.2}, {10.1, 0.4}, {10.3, 0.4}, {10.5, 0.4}}).size() <= 1U);
  for (const std::size_t step : face_steps({{10.0, 0.0}, {10.0, 0.2}, {10.1, 0.4}, {10.3, 0.4}, {10.5, 0.4}}))
    EXPECT_NE(step, 1U);
}

TEST(FaceStep, JoinsNothingAcrossAStepInDepth) {
  EXPECT_TRUE(face_steps({{10.0, 0.0}, {10.0, 0.2}, {12.0, 0.4}, {12.0, 0.6}}).empty());
}

TEST(FaceStep, NeedsFourBeams) {
  EXPECT_TRUE(face_steps({}).empty());
  EXPECT_TRUE(face_steps({{10.0, 0.0}}).empty());
  EXPECT_TRUE(face_steps({{10.0, 0.0}, {10.0, 0.2}, {10.0, 0.4}}).empty());
}

}  // namespace
}  // namespace deltamap::mapping::votes
