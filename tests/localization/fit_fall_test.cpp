// SPDX-License-Identifier: Apache-2.0
#include "localization/fit_fall.hpp"

#include <gtest/gtest.h>

namespace deltamap::localization {
namespace {

constexpr double kScan_s = 0.1;

TEST(FitFall, IsNoticedWithinAFewScansAndForgottenWhenTheFitHasBecomeUsual) {
  FitFall fall;
  for (int i = 0; i < 200; ++i) {
    fall.observe(0.98, kScan_s);
    ASSERT_FALSE(fall.is_recent()) << i;
  }
  for (int i = 0; i < 5; ++i) fall.observe(0.93, kScan_s);
  EXPECT_TRUE(fall.is_recent());
  for (int i = 0; i < 300; ++i) fall.observe(0.93, kScan_s);
  EXPECT_FALSE(fall.is_recent());
}

TEST(FitFall, IsNotMadeOfAFitThatFadesSlowlyOrGrows) {
  FitFall fall;
  for (int i = 0; i < 1000; ++i) {
    fall.observe(0.98 - 0.0001 * i, kScan_s);
    ASSERT_FALSE(fall.is_recent()) << i;
  }
  for (int i = 0; i < 20; ++i) fall.observe(0.99, kScan_s);
  EXPECT_FALSE(fall.is_recent());
}

TEST(FitFall, IsNotMadeOfAFitThatAlwaysWavers) {
  FitFall fall;
  int noticed = 0;
  for (int i = 0; i < 1000; ++i) {
    fall.observe(i % 20 < 10 ? 0.95 : 0.85, kScan_s);
    noticed += i > 200 && fall.is_recent() ? 1 : 0;
  }
  EXPECT_EQ(noticed, 0);
}

}  // namespace
}  // namespace deltamap::localization
