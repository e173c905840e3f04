// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/submap_matcher.hpp"

#include <gtest/gtest.h>

#include "tests/support/scans/surveyed_hall.hpp"

namespace deltamap::surveying::slam {
namespace {

/// Keyframes at the true poses along a way.
Survey known_way(const OccupancyGrid& world, const std::vector<Pose2>& way, Random& random) {
  Survey survey;
  survey.component = {0};
  for (std::size_t i = 0; i < way.size(); ++i) {
    survey.add(keyframe(test::seen_scan(world, way[i], 0.01, random), 0, 0.2 * static_cast<double>(i)));
    survey.poses.back() = way[i];
  }
  return survey;
}

std::vector<Point2> ends_from(const OccupancyGrid& world, const Pose2& pose, Random& random) {
  return mapping::registration::ray_ends(test::seen_scan(world, pose, 0.01, random), 80.0);
}

TEST(SubmapMatcher, PlacesAScanToACentimetre) {
  Random random{2};
  const OccupancyGrid hall = test::drawn_hall(0.02);
  const Survey survey = known_way(hall, test::way_along({{2.0, 7.0}, {8.0, 7.0}}), random);
  SubmapMatcher matcher{submap(survey, 0, 29, 0, 0.0), 1.0};
  const Pose2 truth{6.0, 6.6, 0.2};
  const Pose2 submap_from_scan = motion_between(survey.poses[0], truth);
  const SearchWindow window{
      {submap_from_scan.x + 0.5, submap_from_scan.y - 0.4, submap_from_scan.theta + 0.2}, 1.0, 0.4};
  const auto match = matcher.match(ends_from(hall, truth, random), 0.01, window, {}, {.ambiguous_share = 0.9});
  ASSERT_TRUE(match);
  const Eigen::Vector3d off = difference(submap_from_scan, match->submap_from_scan);
  EXPECT_LT(off.head<2>().norm(), 0.02);
  EXPECT_LT(std::abs(off.z()), 0.004);
  EXPECT_LT(match->covariance(0, 0), 0.03 * 0.03);
}

TEST(SubmapMatcher, LeavesTheLengthOfACorridorToTheWheels) {
  Random random{3};
  OccupancyGrid corridor{{1200, 120, 0.05, {0.0, -1.0}}, CellState::kFree};
  test::fill(corridor, {0.0, -0.1}, {60.0, 0.0}, CellState::kOccupied);
  test::fill(corridor, {0.0, 3.0}, {60.0, 3.1}, CellState::kOccupied);
  const Survey survey = known_way(corridor, test::way_along({{20.0, 1.5}, {26.0, 1.5}}), random);
  SubmapMatcher matcher{submap(survey, 0, 29, 29, 0.0), 0.5};
  const Pose2 truth{26.3, 1.45, 0.05};
  const Pose2 wheels = motion_between(survey.poses[29], {26.35, 1.55, 0.09});
  const PoseCovariance by_wheels = Eigen::Vector3d{0.0025, 0.0025, 0.0025}.asDiagonal();
  const auto match =
      matcher.match(ends_from(corridor, truth, random), 0.01, {wheels, 0.3, 0.2}, {wheels, by_wheels.inverse()}, {});
  ASSERT_TRUE(match);
  const Pose2 sought = motion_between(survey.poses[29], truth);
  EXPECT_NEAR(match->submap_from_scan.x, wheels.x, 0.03);
  EXPECT_NEAR(match->submap_from_scan.y, sought.y, 0.02);
  EXPECT_NEAR(match->submap_from_scan.theta, sought.theta, 0.01);
  EXPECT_GT(match->covariance(0, 0), 10.0 * match->covariance(1, 1));
}

TEST(SubmapMatcher, RefusesWhatFitsInTwoPlacesAndWhatFitsNowhere) {
  Random random{4};
  // Niches that are all alike, 4 m apart.
  OccupancyGrid niches{{600, 120, 0.05, {0.0, -2.0}}, CellState::kFree};
  test::fill(niches, {0.0, 3.0}, {30.0, 3.1}, CellState::kOccupied);
  test::fill(niches, {0.0, -0.1}, {30.0, 0.0}, CellState::kOccupied);
  for (double x = 2.0; x < 30.0; x += 4.0) test::fill(niches, {x, 2.2}, {x + 0.8, 3.0}, CellState::kOccupied);
  const Survey survey = known_way(niches, test::way_along({{4.0, 1.0}, {24.0, 1.0}}), random);
  SubmapMatcher matcher{submap(survey, 0, 99, 50, 0.0), 8.0};
  const std::vector<Point2> ends =
      mapping::registration::ray_ends(test::seen_scan(niches, {13.0, 1.2, 0.1}, 0.01, random, 6.0), 80.0);
  const Pose2 sought = motion_between(survey.poses[50], {13.0, 1.2, 0.1});
  const SubmapMatchParams params{.ambiguous_share = 0.9};
  EXPECT_FALSE(matcher.match(ends, 0.01, {sought, 6.0, 0.2}, {}, params));
  EXPECT_TRUE(matcher.match(ends, 0.01, {sought, 1.0, 0.2}, {}, params));
  const OccupancyGrid hall = test::drawn_hall(0.05);
  EXPECT_FALSE(matcher.match(ends_from(hall, {12.0, 7.0, 1.0}, random), 0.01, {sought, 6.0, 0.2}, {}, params));
}

}  // namespace
}  // namespace deltamap::surveying::slam
