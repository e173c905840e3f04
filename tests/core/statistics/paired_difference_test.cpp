// SPDX-License-Identifier: Apache-2.0
#include "core/statistics/paired_difference.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.hpp"

namespace deltamap {
namespace {

using Of = PairedDifference::Of;

TEST(StudentQuantile, IsThatOfTheTables) {
  EXPECT_NEAR(student_quantile(0.975, 1.0), 12.7062, 1e-3);
  EXPECT_NEAR(student_quantile(0.975, 9.0), 2.26216, 1e-4);
  EXPECT_NEAR(student_quantile(0.995, 4.0), 4.60409, 1e-4);
  EXPECT_NEAR(student_quantile(0.995, 5.0), 4.03214, 1e-4);
  EXPECT_NEAR(student_quantile(0.975, 1e6), 1.95996, 1e-4);
  EXPECT_NEAR(student_quantile(0.025, 9.0), -2.26216, 1e-4);
}

TEST(PairedDifference, OfFewRecordingsSpeaksOfTheirSeeds) {
  const PairedDifference shown = paired_difference({{1.0, 1.1, 0.9, 1.0}, {3.0, 3.1, 2.9, 3.0}});
  EXPECT_EQ(shown.of, Of::kSeeds);
  EXPECT_EQ(shown.pairs, 8u);
  EXPECT_EQ(shown.recordings, 2u);
  EXPECT_DOUBLE_EQ(shown.mean, 2.0);
  EXPECT_TRUE(shown.is_shown());
  EXPECT_LT(shown.high - shown.low, 0.3) << "that one recording differs from the other is no scatter of seeds";
}

TEST(PairedDifference, OfFiveRecordingsSpeaksOfOthersOfTheirKind) {
  const PairedDifference unsure = paired_difference({{1.0, 1.0}, {3.0, 3.0}, {-2.0, -2.0}, {0.5, 0.5}, {-1.0, -1.0}});
  EXPECT_EQ(unsure.of, Of::kRecordings);
  EXPECT_FALSE(unsure.is_shown());
  EXPECT_GT(unsure.high, 2.0);
}

TEST(PairedDifference, IsNoneWhereAllPairsAreEqualAndCertainWhereAllDifferAlike) {
  EXPECT_FALSE(paired_difference({{0.0, 0.0}, {0.0, 0.0}}).is_shown());
  EXPECT_TRUE(paired_difference({{0.1, 0.1}, {0.1, 0.1}}).is_shown());
}

TEST(PairedDifference, HasNoIntervalFromOneSeedOfFewRecordings) {
  const PairedDifference one = paired_difference({{1.0}, {1.0, 1.1}});
  EXPECT_FALSE(one.has_interval());
  EXPECT_FALSE(one.is_shown());
  EXPECT_FALSE(paired_difference({}).has_interval());
}

TEST(PairedDifference, LeavesOutPairsThatAreNone) {
  const PairedDifference shown = paired_difference({{1.0, std::nan(""), 1.1}, {std::nan("")}});
  EXPECT_EQ(shown.pairs, 2u);
  EXPECT_EQ(shown.recordings, 1u);
}

TEST(PairedDifference, FindsADifferenceWhereThereIsNoneAsOftenAsItSays) {
  Random random{7};
  int found = 0;
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<std::vector<double>> differences(3);
    for (auto& recording : differences) {
      for (int seed = 0; seed < 4; ++seed) recording.push_back(random.normal());
    }
    found += paired_difference(differences).is_shown() ? 1 : 0;
  }
  EXPECT_NEAR(found / double{kTrials}, 0.05, 0.015);
}

}  // namespace
}  // namespace deltamap
