// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/slip_search.hpp"

#include <gtest/gtest.h>

#include "tests/localization/surfaces/surroundings.hpp"

namespace deltamap::localization::surfaces::slip_test {
namespace {

TEST(SlipSearch, FindsNoneWhereTheWheelsAreRight) {
  const Surroundings around = aisle_from({});
  EXPECT_FALSE(slip_just_now(around.scene()));
  EXPECT_FALSE(slip_behind(around.scene()));
}

TEST(SlipSearch, FindsATurnOfAnySizeThatTheSurfacesShow) {
  for (const double turn_rad : {-0.15, -0.07, 0.05, 0.12}) {
    const std::optional<Slip> slip = slip_just_now(aisle_from({0.0, 0.0, turn_rad}).scene());
    ASSERT_TRUE(slip) << turn_rad;
    EXPECT_NEAR(slip->led_to.theta, turn_rad, 0.005);
  }
}

TEST(SlipSearch, TakesATurnForASlipOfOneWheelThatLeavesTheRobotWhereItIs) {
  const std::optional<Slip> slip = slip_just_now(aisle_from({0.0, 0.0, 0.07}).scene());
  ASSERT_TRUE(slip);
  EXPECT_FALSE(slip->displaced);
  EXPECT_LT(slip->spread(0, 0), 0.001);
  EXPECT_NEAR(slip->led_to.x, 0.0, 0.01);
}

TEST(SlipSearch, SeesThatBothWheelsHaveSlippedWhereAWallAheadTellsOfIt) {
  const Pose2 truth{-0.3, 0.0, 0.0};
  Surroundings around = aisle_from(truth);
  for (const Surface& wall : {kAhead, facing({1.0, 0.0}, {-4.0, 0.5})}) {
    around.keep_in_view(wall, 0.0, truth);
  }
  const std::optional<Slip> slip = slip_just_now(around.scene());
  ASSERT_TRUE(slip);
  EXPECT_TRUE(slip->displaced);
  EXPECT_NEAR(slip->led_to.x, truth.x, 0.02);
}

TEST(SlipSearch, FindsASlipThatLiesBehindWhereTwoThingsWouldHoldAgain) {
  Surroundings around = aisle_from({});
  (void)around.follow(kAhead, 0.3, 3.0);
  (void)around.follow(facing({-1.0, 0.0}, {5.0, 4.0}), 0.3, 2.0);
  (void)around.follow(facing({1.0, 0.0}, {-4.0, 4.0}), -0.3, 1.0);
  const std::optional<Slip> slip = slip_behind(around.scene());
  ASSERT_TRUE(slip);
  EXPECT_TRUE(slip->displaced);
  EXPECT_NEAR(slip->led_to.x, 0.3, 0.02);
  EXPECT_EQ(slip->read_wrong.size(), 3U);
}

}  // namespace
}  // namespace deltamap::localization::surfaces::slip_test
