// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/hypothesis_report.hpp"

#include <gtest/gtest.h>

namespace deltamap::localization::hypotheses {
namespace {

/// Beside a hypothesis that is believed.
HypothesisBank bank_with(const PoseHypothesis& other) {
  HypothesisBank bank;
  bank.believe({});
  bank.admit(other);
  bank.settle();
  return bank;
}

HypothesisBank believing_bank() {
  HypothesisBank bank;
  bank.believe({});
  return bank;
}

constexpr ReportRules kRules{.kidnapped_now_prior = 0.003, .beats_by = 12.0};

TEST(HypothesisReport, SaysWhereTheRobotMayHaveBeenCarried) {
  const PoseHypothesis other{.map_from_robot = {15.0, 0.0, 0.0}, .since_kidnapping = 7.0};
  const HypothesisReport report = report_on(bank_with(other), believing_bank(), kRules);
  EXPECT_GT(report.kidnapped_share, 0.5);
  EXPECT_DOUBLE_EQ(report.map_from_kidnapped.x, 15.0);
}

TEST(HypothesisReport, HearsOfWatchedAliasesWithoutListingThem) {
  const PoseHypothesis alias{.map_from_robot = {15.0, 0.0, 0.0}, .since_kidnapping = 7.0};
  const HypothesisReport report = report_on(believing_bank(), bank_with(alias), kRules);
  EXPECT_GT(report.kidnapped_share, 0.5);
  EXPECT_EQ(report.listed, 0U);
  EXPECT_FALSE(report.beaten);
}

TEST(HypothesisReport, TakesNoHypothesisForTheTruthThatLosesWhereTheBelievedOneFits) {
  const PoseHypothesis chance{.map_from_robot = {15.0, 0.0, 0.0}, .since_kidnapping = 7.0, .lost_since = 4.0};
  EXPECT_LT(report_on(bank_with(chance), believing_bank(), kRules).kidnapped_share, 0.01);
}

TEST(HypothesisReport, TakesASlipForNoCarrying) {
  const PoseHypothesis slip{.map_from_robot = {0.5, 0.0, 0.0}, .since_kidnapping = 7.0};
  EXPECT_EQ(report_on(bank_with(slip), believing_bank(), kRules).kidnapped_share, 0.0);
}

TEST(HypothesisReport, IsBeatenOnlyByAHypothesisThatHasBeenFollowed) {
  PoseHypothesis other{.map_from_robot = {15.0, 0.0, 0.0}, .log_evidence = 20.0, .followed_m = 0.5};
  EXPECT_FALSE(report_on(bank_with(other), believing_bank(), kRules).beaten);
  other.followed_m = 3.0;
  const HypothesisReport report = report_on(bank_with(other), believing_bank(), kRules);
  EXPECT_TRUE(report.beaten);
  EXPECT_DOUBLE_EQ(report.beaten_for_m, 3.0);
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
