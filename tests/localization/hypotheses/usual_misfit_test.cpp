// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/usual_misfit.hpp"

#include <gtest/gtest.h>

namespace deltamap::localization::hypotheses {
namespace {

double telling_after(double misfit, int scans) {
  UsualMisfit usual;
  for (int i = 0; i < scans; ++i) usual.observe(misfit);
  return usual.telling();
}

TEST(UsualMisfit, LetsABeamTellAllWhereHardlyAnyMisses) {
  EXPECT_DOUBLE_EQ(UsualMisfit{}.telling(), 1.0);
  EXPECT_DOUBLE_EQ(telling_after(0.0, 100), 1.0);
  EXPECT_DOUBLE_EQ(telling_after(0.03, 100), 1.0);
}

TEST(UsualMisfit, LetsItTellLessTheMoreOfThemMissAnyway) {
  EXPECT_NEAR(telling_after(0.2, 500), 0.47, 0.01);
  EXPECT_LT(telling_after(0.4, 500), 0.15);
  EXPECT_DOUBLE_EQ(telling_after(0.9, 500), 0.0);
}

TEST(UsualMisfit, IsNotSwayedByTheFewScansThatShallTell) {
  UsualMisfit usual;
  for (int i = 0; i < 500; ++i) usual.observe(0.0);
  for (int i = 0; i < 3; ++i) usual.observe(0.5);
  EXPECT_GT(usual.telling(), 0.95);
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
