// SPDX-License-Identifier: Apache-2.0
#include "experiments/seed_summary.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/pooled_runs.hpp"

namespace deltamap::experiments {
namespace {

/// Runs of which each found some of what there was.
std::vector<Outcome> runs_that_found(const std::vector<std::pair<double, double>>& found_of) {
  std::vector<Outcome> outcomes;
  for (const auto& [found, there] : found_of) outcomes.push_back({{}, {{"found", found}, {"there", there}}, {}, {}});
  return outcomes;
}

TEST(SeedSummary, SumOfRunsTellsTheirNumberAndHasNoInterval) {
  const auto outcomes = runs_that_found({{1.0, 2.0}, {3.0, 4.0}, {0.0, 0.0}, {2.0, 2.0}, {1.0, 1.0}});
  const Figure sum = sum_of_runs("found", runs_with(outcomes, {}), "found", Target{.most = 6.0}, "kg");
  EXPECT_EQ(sum.name, "found");
  EXPECT_EQ(sum.value, 7.0);
  EXPECT_EQ(sum.unit, "kg");
  EXPECT_EQ(sum.target->most, 6.0);
  ASSERT_TRUE(sum.certainty);
  EXPECT_EQ(sum.certainty->runs, 5u);
  EXPECT_FALSE(sum.certainty->has_interval());
}

TEST(SeedSummary, RatioOfRunsWeighsEachRunByWhatItSawAndDrawsWholeRunsAgain) {
  const auto outcomes = runs_that_found({{0.0, 1.0}, {9.0, 9.0}, {9.0, 9.0}, {9.0, 9.0}, {9.0, 9.0}});
  const Figure ratio = ratio_of_runs("found", runs_with(outcomes, {}), {"found", "there", 100.0});
  EXPECT_NEAR(ratio.value, 100.0 * 36.0 / 37.0, 1e-9) << "not 80, the mean of the runs";
  ASSERT_TRUE(ratio.certainty);
  EXPECT_EQ(ratio.certainty->runs, 5u);
  EXPECT_EQ(ratio.certainty->high, 100.0);
  EXPECT_LT(ratio.certainty->low, 97.0);
  EXPECT_GT(ratio.certainty->low, 50.0);
}

TEST(SeedSummary, RatioToNothingIsNotANumber) {
  const auto outcomes = runs_that_found({{0.0, 0.0}});
  const Figure ratio = ratio_of_runs("found", runs_with(outcomes, {}), {"found", "there"});
  EXPECT_TRUE(std::isnan(ratio.value));
  EXPECT_EQ(ratio.certainty->runs, 1u);
}

TEST(SeedSummary, MeanHasAnIntervalAndTheMostHasNone) {
  const auto outcomes = runs_that_found({{1.0, 1.0}, {2.0, 1.0}, {3.0, 1.0}, {4.0, 1.0}, {5.0, 1.0}});
  const Figure mean = mean_of_runs("found", runs_with(outcomes, {}), "found");
  EXPECT_EQ(mean.value, 3.0);
  EXPECT_TRUE(mean.certainty->has_interval());
  const Figure most = most_of_runs("found", runs_with(outcomes, {}), "found");
  EXPECT_EQ(most.value, 5.0);
  EXPECT_EQ(most.certainty->runs, 5u);
  EXPECT_FALSE(most.certainty->has_interval());
}

TEST(SeedSummary, ChartOfRatiosHasEachRunThatSawAnythingInOrderOfSize) {
  const auto outcomes = runs_that_found({{1.0, 1.0}, {0.0, 0.0}, {1.0, 4.0}});
  const Chart chart = ratios_in_order(
      "found, share", {{"found", {"found", "there"}}, {"twice", {"found", "there", 2.0}}}, runs_with(outcomes, {}));
  EXPECT_EQ(chart.title, "found, share, runs in order");
  ASSERT_EQ(chart.series.size(), 2u);
  const std::vector<std::pair<double, double>> points{{0.5, 0.25}, {1.0, 1.0}};
  EXPECT_EQ(chart.series[0].name, "found");
  EXPECT_EQ(chart.series[0].points, points);
  EXPECT_EQ(chart.series[1].points.back().second, 2.0);
}

}  // namespace
}  // namespace deltamap::experiments
