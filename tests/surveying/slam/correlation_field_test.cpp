// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/correlation_field.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/random.hpp"

namespace deltamap::surveying::slam {
namespace {

/// Ends on an L of walls.
std::vector<Point2> corner(double long_m, double short_m) {
  std::vector<Point2> ends;
  for (double along = 0.0; along < long_m; along += 0.1) ends.emplace_back(along, 0.0);
  for (double along = 0.0; along < short_m; along += 0.1) ends.emplace_back(0.0, along);
  return ends;
}

std::vector<Point2> seen_from(const Pose2& pose, const std::vector<Point2>& ends) {
  std::vector<Point2> seen;
  for (const Point2& end : ends) seen.push_back(inverse(pose) * end);
  return seen;
}

TEST(CorrelationField, FindsThePoseWithinALatticeStep) {
  const std::vector<Point2> ends = corner(6.0, 3.0);
  const CorrelationField field{ends, 0.1, 6};
  Random random{3};
  for (int i = 0; i < 20; ++i) {
    const Pose2 truth{4.0 + random.uniform(), 3.0 + random.uniform(), 6.0 * random.uniform()};
    const SearchWindow window{
        {truth.x + random.uniform() - 0.5, truth.y + random.uniform() - 0.5, truth.theta + 0.3}, 1.0, 0.5};
    const auto match = best_match(field, seen_from(truth, ends), window, 0.5, 1.0);
    ASSERT_TRUE(match);
    EXPECT_GT(match->score, 0.8);
    EXPECT_LT(distance_between(match->field_from_scan, truth), 0.15);
    EXPECT_LT(std::abs(turn_between(match->field_from_scan.theta, truth.theta)), 0.04);
  }
}

TEST(CorrelationField, TellsWhetherTheBestLiesAtTheRimOfTheWindow) {
  const std::vector<Point2> ends = corner(6.0, 3.0);
  const CorrelationField field{ends, 0.1, 6};
  const Pose2 truth{4.0, 3.0, 0.5};
  const std::vector<Point2> seen = seen_from(truth, ends);
  const auto found = [&](const Pose2& off) { return best_match(field, seen, {truth * off, 0.3, 0.1}, 0.1, 1.0); };
  ASSERT_TRUE(found({}) && found({0.6, 0.0, 0.0}) && found({0.0, 0.0, 0.2}));
  EXPECT_FALSE(found({})->is_at_rim);
  EXPECT_TRUE(found({0.6, 0.0, 0.0})->is_at_rim);
  EXPECT_TRUE(found({0.0, 0.0, 0.2})->is_at_rim);
}

TEST(CorrelationField, ABranchIsNeverCutThatHoldsTheBest) {
  Random random{5};
  for (int trial = 0; trial < 30; ++trial) {
    std::vector<Point2> ends;
    std::vector<Point2> scan;
    for (int i = 0; i < 40; ++i) ends.emplace_back(8.0 * random.uniform(), 8.0 * random.uniform());
    for (int i = 0; i < 15; ++i) scan.emplace_back(4.0 * random.uniform(), 4.0 * random.uniform());
    const SearchWindow window{{2.0, 2.0, 0.4}, 2.0, 1.0};
    const auto fast = best_match(CorrelationField{ends, 0.1, 6}, scan, window, 0.0, 1.0);
    const auto exhaustive = best_match(CorrelationField{ends, 0.1, 1}, scan, window, 0.0, 1.0);
    ASSERT_TRUE(fast && exhaustive);
    EXPECT_EQ(fast->score, exhaustive->score);
  }
}

TEST(CorrelationField, TellsOfAnotherPlaceThatFitsAsWell) {
  std::vector<Point2> ends = corner(4.0, 2.0);
  const std::vector<Point2> one = ends;
  for (const Point2& end : one) ends.emplace_back(end.x() + 10.0, end.y());
  const CorrelationField field{ends, 0.1, 6};
  const SearchWindow both{{6.0, 1.0, 0.0}, 8.0, 0.3};
  const auto ambiguous = best_match(field, seen_from({1.0, 1.0, 0.0}, one), both, 0.5, 0.9);
  ASSERT_TRUE(ambiguous);
  EXPECT_GT(ambiguous->elsewhere, 0.9 * ambiguous->score);
  const SearchWindow alone{{1.0, 1.0, 0.0}, 3.0, 0.3};
  const auto sure = best_match(field, seen_from({1.0, 1.0, 0.0}, one), alone, 0.5, 0.9);
  ASSERT_TRUE(sure);
  EXPECT_EQ(sure->elsewhere, 0.0);
}

TEST(CorrelationField, HasNoAnswerWhereNothingFits) {
  const CorrelationField field{corner(6.0, 3.0), 0.1, 6};
  const SearchWindow everywhere{{3.0, 1.5, 0.0}, 5.0, std::numbers::pi};
  std::vector<Point2> circle;
  for (double angle = 0.0; angle < 6.28; angle += 0.1)
    circle.emplace_back(2.0 * std::cos(angle), 2.0 * std::sin(angle));
  EXPECT_FALSE(best_match(field, circle, everywhere, 0.5, 1.0));
  EXPECT_FALSE(best_match(field, {}, everywhere, 0.0, 1.0));
  EXPECT_FALSE(best_match(CorrelationField{{}, 0.1, 4}, circle, everywhere, 0.0, 1.0)) << "nothing has been seen";
}

}  // namespace
}  // namespace deltamap::surveying::slam
