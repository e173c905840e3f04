// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/outlier_rate.hpp"

#include <gtest/gtest.h>

namespace deltamap::localization::hypotheses {
namespace {

double telling_after(double misfit, int scans) {
  OutlierRate usual;
  for (int i = 0; i < scans; ++i) usual.observe(misfit);
  return usual.evidence_weight();
}

TEST(OutlierRate, LetsABeamTellAllWhereHardlyAnyMisses) {
  EXPECT_DOUBLE_EQ(OutlierRate{}.evidence_weight(), 1.0);
  EXPECT_DOUBLE_EQ(telling_after(0.0, 100), 1.0);
  EXPECT_DOUBLE_EQ(telling_after(0.03, 100), 1.0);
}

TEST(OutlierRate, LetsItTellLessTheMoreOfThemMissAnyway) {
  EXPECT_NEAR(telling_after(0.2, 500), 0.47, 0.01);
  EXPECT_LT(telling_after(0.4, 500), 0.15);
  EXPECT_DOUBLE_EQ(telling_after(0.9, 500), 0.0);
}

TEST(OutlierRate, IsNotSwayedByTheFewScansThatShallTell) {
  OutlierRate usual;
  for (int i = 0; i < 500; ++i) usual.observe(0.0);
  for (int i = 0; i < 3; ++i) usual.observe(0.5);
  EXPECT_GT(usual.evidence_weight(), 0.95);
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
