// SPDX-License-Identifier: Apache-2.0
#include "surveying/grid_registration/prior_merge.hpp"

#include <gtest/gtest.h>

#include "core/grid/grid_ray.hpp"
#include "core/random.hpp"
#include "tests/support/worlds/drawn_hall.hpp"
#include "tests/surveying/grid_registration/wrong_guess.hpp"

namespace deltamap::surveying::grid_registration {
namespace {

/// What a laser sees of a map from a pose: 360 beams, at most 12 m, with range noise.
std::vector<Point2> seen_from(const OccupancyGrid& map, const Pose2& map_from_laser, Random& random) {
  std::vector<Point2> hits;
  for (int i = 0; i < 360; ++i) {
    const double bearing_rad = map_from_laser.theta + radians(i);
    const Point2 towards{std::cos(bearing_rad), std::sin(bearing_rad)};
    walk_ray(map.geometry(), map_from_laser.position(), map_from_laser.position() + 12.0 * towards,
             [&](Cell cell, double entered_m) {
               if (map.at(cell) != CellState::kOccupied) return true;
               hits.emplace_back(map_from_laser.position() + (entered_m + random.normal(0.01)) * towards);
               return false;
             });
  }
  return hits;
}

std::vector<Point2> moved(const Pose2& b_from_a, const std::vector<Point2>& points) {
  std::vector<Point2> result;
  for (const Point2& point : points) result.push_back(b_from_a * point);
  return result;
}

TEST(PriorMerge, FindsTheErrorsThatThePriorAllows) {
  const OccupancyGrid hall = test::drawn_hall(0.05);
  const Pose2 robot{7.0, 6.5, 0.3};
  Random random{1};
  for (int trial = 0; trial < 40; ++trial) {
    const Pose2 by{random.normal(0.12), random.normal(0.12), random.normal(0.05)};
    const Pose2 error = guess_from_map(robot.position(), by.x, by.y, by.theta);
    const auto guessed = moved(error, seen_from(hall, robot, random));
    const PriorMerge merge =
        prior_merge(hall, guessed, {error * robot.position(), covariance_of(0.12, 0.05)}, PriorMergeParams{});
    ASSERT_TRUE(merge.accepted()) << trial << ": " << name_of(merge.refusal);
    const Pose2 rest = merge.map_from_guess * error;
    const Point2 off = rest * robot.position() - robot.position();
    EXPECT_LT(off.norm(), 0.04) << trial;
    EXPECT_LT(std::abs(rest.theta), radians(0.4)) << trial;
    EXPECT_GT(merge.agreement, 0.95);
  }
}

TEST(PriorMerge, LeavesAnUnobservedAxisToThePrior) {
  OccupancyGrid corridor{{400, 60, 0.05, {0.0, 0.0}}};
  test::fill(corridor, {0.0, 0.5}, {20.0, 2.5}, CellState::kFree);
  test::fill(corridor, {0.0, 0.4}, {20.0, 0.5}, CellState::kOccupied);
  test::fill(corridor, {0.0, 2.5}, {20.0, 2.6}, CellState::kOccupied);
  const Pose2 robot{10.0, 1.5, 0.0};
  Random random{2};
  auto hits = seen_from(corridor, robot, random);
  std::erase_if(hits, [](const Point2& hit) { return std::abs(hit.x() - 10.0) > 4.0; });
  const Pose2 error = guess_from_map(robot.position(), 0.1, 0.1, 0.02);
  const PriorMerge merge =
      prior_merge(corridor, moved(error, hits), {error * robot.position(), covariance_of(0.1, 0.03)}, {});
  ASSERT_TRUE(merge.accepted()) << name_of(merge.refusal);
  const Point2 corrected = merge.map_from_guess * (error * robot.position());
  EXPECT_NEAR(corrected.y(), 1.5, 0.03);
  EXPECT_NEAR(corrected.x(), 10.1, 0.02);
  EXPECT_GT(merge.covariance(0, 0), 0.9 * 0.1 * 0.1);
  EXPECT_LT(merge.covariance(1, 1), 0.02 * 0.02);
}

TEST(PriorMerge, RefusesACorrectionThatThePriorFindsImplausible) {
  const OccupancyGrid hall = test::drawn_hall(0.05);
  const Pose2 robot{7.0, 6.5, 0.0};
  Random random{3};
  const Pose2 error = guess_from_map(robot.position(), 0.25, 0.0, 0.0);
  const auto guessed = moved(error, seen_from(hall, robot, random));
  const PosePrior sure{error * robot.position(), covariance_of(0.01, 0.005)};
  PriorMergeParams far;
  far.search_deviations = 10.0;
  EXPECT_EQ(prior_merge(hall, guessed, sure, far).refusal, mapping::merge::MergeRefusal::kImplausible);
  const PosePrior unsure{error * robot.position(), covariance_of(0.2, 0.005)};
  EXPECT_TRUE(prior_merge(hall, guessed, unsure, {}).accepted());
}

TEST(PriorMerge, RefusesAPlaceThatTheMapDoesNotShow) {
  const OccupancyGrid hall = test::drawn_hall(0.05);
  Random random{4};
  std::vector<Point2> scattered;
  for (int i = 0; i < 200; ++i) scattered.push_back(Point2{random.uniform(4.0, 18.0), random.uniform(5.8, 8.2)});
  const PriorMerge merge = prior_merge(hall, scattered, {{7.0, 6.5}, covariance_of(0.1, 0.05)}, {});
  EXPECT_EQ(merge.refusal, mapping::merge::MergeRefusal::kLowAgreement);
  EXPECT_EQ(merge.map_from_guess, Pose2{});
}

TEST(PriorMerge, RefusesARackWhosePostsFitTwice) {
  OccupancyGrid rack{{400, 120, 0.05, {0.0, 0.0}}, CellState::kFree};
  for (double x = 1.0; x < 19.0; x += 0.6) test::fill(rack, {x, 3.0}, {x + 0.3, 3.3}, CellState::kOccupied);
  Random random{5};
  std::vector<Point2> faces;  // the teeth of the rack, seen half a period off
  for (double x = 7.0; x < 13.0; x += 0.6) {
    for (double step = 0.0; step < 0.3; step += 0.03) {
      faces.emplace_back(x + step + 0.3, 3.0);
      faces.emplace_back(x + 0.3, 3.0 + step);
    }
  }
  const PriorMerge merge = prior_merge(rack, faces, {{10.0, 1.0}, covariance_of(0.4, 0.01)}, {});
  EXPECT_EQ(merge.refusal, mapping::merge::MergeRefusal::kAmbiguous);
}

TEST(PriorMerge, RefusesTooFewPointsAndAnEmptyMap) {
  const OccupancyGrid hall = test::drawn_hall();
  const std::vector<Point2> few(5, Point2{1.0, 1.0});
  EXPECT_EQ(prior_merge(hall, few, {}, {}).refusal, mapping::merge::MergeRefusal::kTooFewPoints);
  const std::vector<Point2> many(50, Point2{1.0, 1.0});
  const OccupancyGrid empty{{100, 100, 0.1, {0.0, 0.0}}};
  EXPECT_EQ(prior_merge(empty, many, {}, {}).refusal, mapping::merge::MergeRefusal::kLowAgreement);
  const std::vector<Point2> outside(50, Point2{500.0, -500.0});
  EXPECT_EQ(prior_merge(hall, outside, {}, {}).refusal, mapping::merge::MergeRefusal::kLowAgreement);
}

}  // namespace
}  // namespace deltamap::surveying::grid_registration
