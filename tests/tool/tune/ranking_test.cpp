// SPDX-License-Identifier: Apache-2.0
#include "tool/tune/ranking.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace deltamap::tool::tune {
namespace {

const Measure& error() { return measure_named("error_rmse_m"); }

TEST(Ranking, NamesTheBestAndTheFirstThatIsNotShownToBeWorse) {
  const MeasuredValues values{{{5.0, 5.1, 4.9}, {7.0, 7.1, 6.9}},      // clearly worse
                              {{1.02, 1.11, 0.9}, {3.0, 3.09, 2.93}},  // as good
                              {{1.0, 1.1, 0.92}, {3.01, 3.1, 2.9}}};
  const Ranking ranking = ranking_of(values, error());
  EXPECT_EQ(ranking.best, 2u);
  EXPECT_EQ(ranking.first_not_worse, 1u);
  EXPECT_TRUE(ranking.tells);
  EXPECT_TRUE(ranking.variants[0].is_worse);
  EXPECT_NEAR(ranking.variants[0].mean, 6.0, 1e-9);
  EXPECT_NEAR(ranking.variants[0].of_drives[1], 7.0, 1e-9);
}

TEST(Ranking, TellsNothingWhereAllAreAlike) {
  const Ranking ranking = ranking_of({{{1.0, 1.2, 0.8}}, {{1.1, 0.9, 1.05}}, {{0.9, 1.1, 1.0}}}, error());
  EXPECT_FALSE(ranking.tells);
  EXPECT_EQ(ranking.first_not_worse, 0u);
}

TEST(Ranking, TakesMoreForBetterWhereTheMeasureSaysSo) {
  const MeasuredValues values{{{0.9, 0.91}}, {{0.5, 0.52}}};
  EXPECT_EQ(ranking_of(values, measure_named("agreement")).best, 0u);
  EXPECT_EQ(ranking_of(values, error()).best, 1u);
}

TEST(Ranking, OfOneSeedNamesTheBestWithoutCallingOthersWorse) {
  const Ranking ranking = ranking_of({{{2.0}}, {{1.0}}}, error());
  EXPECT_FALSE(ranking.has_intervals);
  EXPECT_EQ(ranking.best, 1u);
  EXPECT_EQ(ranking.first_not_worse, 1u) << "nothing is known of the other";
}

TEST(Ranking, OfWhatWasNotMeasuredThrows) {
  EXPECT_THROW((void)ranking_of({{{std::nan("")}}}, error()), std::runtime_error);
}

TEST(Verdict, IsSaidInWords) {
  const auto words = [](const PairedDifference& difference, const char* measure) {
    return verdict_of(difference, measure_named(measure), "A", "B");
  };
  EXPECT_EQ(words(paired_difference({{0.1, -0.1, 0.02}}), "error_rmse_m"),
            "no difference that these recordings can show");
  EXPECT_EQ(words(paired_difference({{0.1, 0.11, 0.12}}), "error_rmse_m"), "A is better");
  EXPECT_EQ(words(paired_difference({{0.1, 0.11, 0.12}}), "agreement"), "B is better");
  EXPECT_EQ(words(paired_difference({{0.1}}), "agreement"), "too few runs to tell: give more seeds");
}

}  // namespace
}  // namespace deltamap::tool::tune
