// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/rival_report.hpp"

#include <gtest/gtest.h>

namespace deltamap::localization::hypotheses {
namespace {

/// Beside a place that is believed.
PlaceBank bank_with(const Place& other) {
  PlaceBank bank{{}};
  bank.believe({});
  bank.admit(other);
  bank.settle();
  return bank;
}

PlaceBank believing_bank() {
  PlaceBank bank{{}};
  bank.believe({});
  return bank;
}

TEST(RivalReport, SaysWhereTheRobotMayHaveBeenCarried) {
  const Place other{.map_from_robot = {15.0, 0.0, 0.0}, .since_carried = 7.0};
  const RivalReport report = report_on(bank_with(other), believing_bank(), {});
  EXPECT_GT(report.carried_share, 0.5);
  EXPECT_DOUBLE_EQ(report.map_from_carried.x, 15.0);
}

TEST(RivalReport, HearsOfWatchedImagesWithoutListingThem) {
  const Place image{.map_from_robot = {15.0, 0.0, 0.0}, .since_carried = 7.0};
  const RivalReport report = report_on(believing_bank(), bank_with(image), {});
  EXPECT_GT(report.carried_share, 0.5);
  EXPECT_EQ(report.listed, 0U);
  EXPECT_FALSE(report.beaten);
  EXPECT_TRUE(report.unique);
}

TEST(RivalReport, TakesNoPlaceForTheTruthThatLosesWhereTheBelievedOneFits) {
  const Place chance{.map_from_robot = {15.0, 0.0, 0.0}, .since_carried = 7.0, .lost_since = 4.0};
  EXPECT_LT(report_on(bank_with(chance), believing_bank(), {}).carried_share, 0.01);
}

TEST(RivalReport, TakesASlipForNoCarrying) {
  const Place slip{.map_from_robot = {0.5, 0.0, 0.0}, .since_carried = 7.0};
  EXPECT_EQ(report_on(bank_with(slip), believing_bank(), {}).carried_share, 0.0);
}

TEST(RivalReport, IsBeatenOnlyByAPlaceThatHasBeenFollowed) {
  Place other{.map_from_robot = {15.0, 0.0, 0.0}, .log_evidence = 20.0, .followed_m = 0.5};
  EXPECT_FALSE(report_on(bank_with(other), believing_bank(), {}).beaten);
  other.followed_m = 3.0;
  const RivalReport report = report_on(bank_with(other), believing_bank(), {});
  EXPECT_TRUE(report.beaten);
  EXPECT_DOUBLE_EQ(report.beaten_for_m, 3.0);
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
