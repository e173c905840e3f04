// SPDX-License-Identifier: Apache-2.0
#include "mapping/alignment/scan_matching.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "core/geometry/angle.hpp"
#include "core/random.hpp"
#include "tests/support/scans/seen_scan.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping::alignment {
namespace {

TEST(ScanMatch, FindsTheMotionBetweenTwoScansWithinItsCovariance) {
  const OccupancyGrid hall = test::drawn_hall(0.02);
  Random random{1};
  double chi2_sum = 0.0;
  constexpr int kTrials = 40;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Pose2 first{random.uniform(6.5, 7.5), random.uniform(6.0, 7.5), random.uniform(-3.0, 3.0)};
    const Pose2 second = test::disturbed(first, 0.4, 0.2, random);
    const ScanMatchingParams params;
    const TrackedScan from = test::seen_scan(hall, first, 0.01, random);
    const TrackedScan to = test::seen_scan(hall, second, 0.01, random);
    const Pose2 guess = test::disturbed(motion_between(first, second), 0.1, 0.03, random);
    const auto match = scan_match(matchable(from, params), matchable(to, params), guess, params);
    ASSERT_TRUE(match) << trial;
    const Pose2 truth = motion_between(first, second);
    const Eigen::Vector3d error{match->first_from_second.x - truth.x, match->first_from_second.y - truth.y,
                                turn_between(truth.theta, match->first_from_second.theta)};
    EXPECT_LT(error.head<2>().norm(), 0.04) << trial;
    EXPECT_LT(std::abs(error.z()), radians(0.4)) << trial;
    chi2_sum += error.dot(match->covariance.inverse() * error);
  }
  EXPECT_LT(chi2_sum / kTrials, 6.0) << "the covariance claims more than is true (3 expected)";
  EXPECT_GT(chi2_sum / kTrials, 0.3) << "the covariance claims nothing";
}

TEST(ScanMatch, LeavesTheLengthOfACorridorUnobserved) {
  OccupancyGrid corridor{{2000, 150, 0.02, {0.0, 0.0}}};
  test::fill(corridor, {0.0, 0.46}, {40.0, 0.5}, CellState::kOccupied);
  test::fill(corridor, {0.0, 2.5}, {40.0, 2.54}, CellState::kOccupied);
  Random random{2};
  const ScanMatchingParams params;
  const auto match = scan_match(matchable(test::seen_scan(corridor, {20.0, 1.5, 0.0}, 0.01, random, 8.0), params),
                                matchable(test::seen_scan(corridor, {20.3, 1.4, 0.0}, 0.01, random, 8.0), params),
                                {0.25, -0.05, 0.02}, params);
  ASSERT_TRUE(match);
  EXPECT_GT(match->covariance(0, 0), 0.3 * 0.3);
  EXPECT_LT(match->covariance(1, 1), 0.02 * 0.02);
  EXPECT_NEAR(match->first_from_second.y, -0.1, 0.02);
  EXPECT_NEAR(match->first_from_second.x, 0.25, 0.25) << "what is not observed stays near where it was";
}

TEST(ScanMatch, HasNoAnswerForScansOfDifferentPlaces) {
  const OccupancyGrid hall = test::drawn_hall(0.02);
  Random random{3};
  const ScanMatchingParams params;
  const auto first = matchable(test::seen_scan(hall, {1.5, 7.0, 1.6}, 0.01, random), params);
  const auto second = matchable(test::seen_scan(hall, {18.5, 3.0, -0.3}, 0.01, random), params);
  EXPECT_FALSE(scan_match(first, second, {}, params));
  const auto blind = matchable(TrackedScan{}, params);
  EXPECT_FALSE(scan_match(first, blind, {}, params));
  EXPECT_FALSE(scan_match(blind, first, {}, params));
}

}  // namespace
}  // namespace deltamap::mapping::alignment
