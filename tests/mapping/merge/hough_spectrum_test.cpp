// SPDX-License-Identifier: Apache-2.0
#include "mapping/merge/hough_spectrum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/geometry/angle.hpp"

namespace deltamap::mapping::merge {
namespace {

std::vector<PointInCells> line_at(double direction_rad, float distance) {
  const auto c = static_cast<float>(std::cos(direction_rad));
  const auto s = static_cast<float>(std::sin(direction_rad));
  std::vector<PointInCells> points;
  for (int i = -40; i <= 40; ++i) {
    const auto along = static_cast<float>(i);
    points.push_back({c * along - s * distance, s * along + c * distance});
  }
  return points;
}

TEST(HoughSpectrum, IsLargestAtTheNormalOfALineWhereverItLies) {
  for (const float distance : {0.0F, 7.3F, -22.0F}) {
    const std::vector<double> spectrum = hough_spectrum(line_at(radians(30.0), distance));
    ASSERT_EQ(spectrum.size(), 360U);
    const auto largest = std::max_element(spectrum.begin(), spectrum.end()) - spectrum.begin();
    EXPECT_EQ(largest % 180, 120);
    EXPECT_EQ(spectrum[10], spectrum[190]) << "the period is 180°";
  }
}

TEST(HoughSpectrum, EqualsTheSumOfSquaresCountedByHand) {
  // Three points on the line x = 2: at θ = 0 all vote for ρ = 2, at θ = 90° each for its own ρ.
  const std::vector<PointInCells> points{{2.0F, -1.0F}, {2.0F, 0.0F}, {2.0F, 1.0F}};
  const std::vector<double> spectrum = hough_spectrum(points);
  EXPECT_NEAR(spectrum[0], 9.0, 1e-6);
  EXPECT_NEAR(spectrum[90], 3.0, 0.3);
}

TEST(CircularCorrelation, EqualsEquation6ByHand) {
  const std::vector<double> one{1.0, 2.0, 3.0, 4.0};
  const std::vector<double> other{0.0, 1.0, 0.0, 2.0};
  // l = 0: 2 + 8; l = 1: other(i + 1) = 1 0 2 0 -> 1 + 6; l = 2: 0 2 0 1 -> 4 + 4; l = 3: 2 0 1 0 -> 2 + 3
  EXPECT_EQ(circular_correlation(one, other), (std::vector<double>{10.0, 7.0, 8.0, 5.0}));
}

TEST(BestTurns, TurnTheSecondMapOntoTheFirst) {
  for (const double turn_deg : {0.0, 17.0, -49.0, 88.0, 151.0}) {
    const auto first = hough_spectrum(line_at(radians(20.0), 5.0F));
    const auto second = hough_spectrum(line_at(radians(20.0 - turn_deg), 5.0F));
    const auto turns = best_turns(first, second, 1, false);
    ASSERT_EQ(turns.size(), 2U) << "a line cannot tell a half turn";
    const bool found = std::any_of(turns.begin(), turns.end(), [&](double turn_rad) {
      return std::abs(turn_between(turn_rad, radians(turn_deg))) < radians(0.6);
    });
    EXPECT_TRUE(found) << turn_deg;
    EXPECT_NEAR(std::abs(turn_between(turns[0], turns[1])), std::numbers::pi, 1e-9);
  }
}

}  // namespace
}  // namespace deltamap::mapping::merge
