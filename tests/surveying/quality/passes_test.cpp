// SPDX-License-Identifier: Apache-2.0
#include "surveying/quality/passes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace deltamap::surveying::quality {
namespace {

std::vector<PlacedScan> straight(int scans, double step_m, std::uint32_t drive) {
  std::vector<PlacedScan> placed;
  for (int i = 0; i < scans; ++i) placed.push_back({nullptr, {step_m * i, 0.0, 0.0}, drive});
  return placed;
}

TEST(Passes, AreThreeMetresLongAndBelongToOneDrive) {
  std::vector<PlacedScan> scans = straight(50, 0.2, 0);
  for (const PlacedScan& scan : straight(10, 0.2, 1)) scans.push_back(scan);
  const std::vector<Pass> passes = passes_of(scans);
  ASSERT_EQ(passes.size(), 5U);
  std::uint32_t next = 0;
  for (const Pass& pass : passes) {
    EXPECT_EQ(pass.first, next);
    EXPECT_LE(pass.ended_m - pass.began_m, 3.01);
    EXPECT_EQ(scans[pass.first].drive, scans[pass.last].drive);
    next = pass.last + 1;
  }
  EXPECT_EQ(next, scans.size());
  EXPECT_NEAR(passes[0].middle.x(), 1.5, 0.11);
  EXPECT_NEAR(way_between(passes[0], passes[2]), passes[2].began_m - passes[0].ended_m, 1e-9);
  EXPECT_TRUE(std::isinf(way_between(passes[0], passes[4])));
}

TEST(Passes, LeaveOutScansOfARobotThatStands) {
  std::vector<PlacedScan> scans(30, PlacedScan{});
  scans.push_back({nullptr, {0.0, 0.0, 0.1}, 0});
  scans.push_back({nullptr, {0.2, 0.0, 0.1}, 0});
  EXPECT_EQ(thinned(scans).size(), 3U);
}

}  // namespace
}  // namespace deltamap::surveying::quality
