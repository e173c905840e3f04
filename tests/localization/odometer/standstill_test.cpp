// SPDX-License-Identifier: Apache-2.0
#include "localization/odometer/standstill.hpp"

#include <gtest/gtest.h>

#include "localization/motion/deskew.hpp"
#include "tests/support/scans/cast_scan.hpp"
#include "tests/support/worlds/room_and_corridor.hpp"

namespace deltamap::localization::odometer {
namespace {

class StandstillTest : public ::testing::Test {
 protected:
  Scan seen_from(const OccupancyGrid& world, const Pose2& pose) {
    return test::cast_scan(world, pose, timestamp_from_ns(0), {}, random_);
  }
  static double log_odds(const Standstill& kept, const Scan& scan, const Pose2& claimed) {
    return kept.log_odds(scan, motion::deskewed(scan, {}), claimed, Standstill::kClearlyMoved);
  }
  Random random_{5};
};

TEST_F(StandstillTest, AScanOfTheSamePlaceIsTheSameAndOneFromElsewhereIsNot) {
  const OccupancyGrid world = test::room_with_pillar();
  const Scan first = seen_from(world, {2.0, 3.0, 0.0});
  Standstill kept;
  kept.keep(first, motion::deskewed(first, {}));
  EXPECT_TRUE(kept.is_same(seen_from(world, {2.0, 3.0, 0.0})));
  EXPECT_FALSE(kept.is_same(seen_from(world, {2.2, 3.0, 0.0})));
  EXPECT_FALSE(kept.is_same(seen_from(world, {2.0, 3.0, 0.1})));
}

TEST_F(StandstillTest, RefutesWhatWheelsClaimInARoom) {
  const OccupancyGrid world = test::room_with_pillar();
  const Scan first = seen_from(world, {2.0, 3.0, 0.0});
  Standstill kept;
  kept.keep(first, motion::deskewed(first, {}));
  const Scan again = seen_from(world, {2.0, 3.0, 0.0});
  for (const Pose2& claimed : {Pose2{0.3, 0.0, 0.0}, Pose2{0.05, 0.0, 0.2}, Pose2{-0.4, 0.0, 0.0}})
    EXPECT_GT(log_odds(kept, again, claimed), 15.0) << claimed.x;
}

TEST_F(StandstillTest, SaysThatItMovedWhereItDid) {
  const OccupancyGrid world = test::room_with_pillar();
  const Scan first = seen_from(world, {2.0, 3.0, 0.0});
  Standstill kept;
  kept.keep(first, motion::deskewed(first, {}));
  EXPECT_LE(log_odds(kept, seen_from(world, {2.1, 3.0, 0.0}), {0.1, 0.0, 0.0}), Standstill::kClearlyMoved);
}

TEST_F(StandstillTest, TriesNoFurtherMotionOnceTheOddsAreLowEnough) {
  const OccupancyGrid world = test::room_with_pillar();
  const Scan first = seen_from(world, {2.0, 3.0, 0.0});
  Standstill kept;
  kept.keep(first, motion::deskewed(first, {}));
  const Scan again = seen_from(world, {2.0, 3.0, 0.0});
  const auto rays = motion::deskewed(again, {});
  const Pose2 claimed{0.03, 0.0, 0.0};
  const double best = kept.log_odds(again, rays, claimed, Standstill::kClearlyMoved);
  EXPECT_GT(kept.log_odds(again, rays, claimed, 1e9), best) << "as the wheels claim, which is not the best motion";
  EXPECT_EQ(kept.log_odds(again, rays, claimed, best - 0.1), best);
}

TEST_F(StandstillTest, SaysNothingInTheMiddleOfABareCorridor) {
  const OccupancyGrid world = test::long_corridor();
  test::CastScanner short_sighted{.max_range_m = 8.0};
  const Scan first = test::cast_scan(world, {20.0, 1.0, 0.0}, timestamp_from_ns(0), short_sighted, random_);
  Standstill kept;
  kept.keep(first, motion::deskewed(first, {}));
  const Scan again = test::cast_scan(world, {20.0, 1.0, 0.0}, timestamp_from_ns(0), short_sighted, random_);
  EXPECT_TRUE(kept.is_same(again));
  EXPECT_LT(std::abs(log_odds(kept, again, {0.3, 0.0, 0.0})), 20.0);
}

TEST_F(StandstillTest, TakesNothingFromALaserThatRepeatsItself) {
  const Scan first = seen_from(test::room_with_pillar(), {2.0, 3.0, 0.0});
  Standstill kept;
  kept.keep(first, motion::deskewed(first, {}));
  EXPECT_FALSE(kept.is_same(first)) << "to the last digit";
}

}  // namespace
}  // namespace deltamap::localization::odometer
