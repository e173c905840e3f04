// SPDX-License-Identifier: Apache-2.0
#include "localization/tracking/slip_finder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.hpp"
#include "tests/support/scans/cast_ends.hpp"
#include "tests/support/worlds/pillar_room.hpp"

namespace deltamap::localization::tracking {
namespace {

constexpr double kBeamShare = 20.0 / 181.0;
const Pose2 kStands{2.0, 2.0, 0.5};

class SlipFinderInARoom : public testing::Test {
 protected:
  SlipFinderInARoom() { finder_.learn(field_, ends_, kStands); }
  [[nodiscard]] std::span<const Pose2> slips_from(const Pose2& by_wheels) {
    return finder_.slips(field_, ends_, by_wheels, kBeamShare);
  }

  OccupancyGrid map_ = test::pillar_room();
  sensor::LikelihoodField field_{map_, {}};
  motion::BeamEnds ends_ = test::cast_ends(map_, kStands);
  SlipFinder finder_{{}, {}};
};

TEST_F(SlipFinderInARoom, FindsWhereTheRobotStandsAfterUsualSlips) {
  for (const double along_m : {-0.15, 0.0, 0.15}) {
    for (const double turn_deg : {-8.0, -4.0, 4.0, 8.0}) {
      const std::span<const Pose2> slips = slips_from(kStands * Pose2{along_m, 0.02, radians(turn_deg)});
      ASSERT_FALSE(slips.empty()) << along_m << ' ' << turn_deg;
      const bool found = std::any_of(slips.begin(), slips.end(), [](const Pose2& slip) {
        return distance_between(slip, kStands) < 0.04 && std::abs(wrapped_angle(slip.theta - kStands.theta)) < 0.01;
      });
      EXPECT_TRUE(found) << along_m << ' ' << turn_deg;
    }
  }
}

TEST_F(SlipFinderInARoom, FindsNoneWhereTheWheelsAreRight) { EXPECT_TRUE(slips_from(kStands).empty()); }

TEST_F(SlipFinderInARoom, FindsNoneBeforeItHasLearnedHowScansFit) {
  finder_.forget();
  EXPECT_TRUE(slips_from(kStands * Pose2{0.1, 0.0, 0.1}).empty());
}

TEST_F(SlipFinderInARoom, FindsNoneWhereTheWorldHasChangedAndNothingNearFitsAsBefore) {
  OccupancyGrid changed = map_;
  test::fill_box(changed, {2.6, 1.9}, {3.0, 3.2}, CellState::kOccupied);
  ends_ = test::cast_ends(changed, kStands);
  EXPECT_TRUE(slips_from(kStands).empty());
}

TEST_F(SlipFinderInARoom, FindsNoneWhereSlipsAreNeverBelieved) {
  finder_ = SlipFinder{{.slip_probability = 0.0}, {}};
  finder_.learn(field_, ends_, kStands);
  EXPECT_TRUE(slips_from(kStands * Pose2{0.1, 0.0, 0.1}).empty());
}

}  // namespace
}  // namespace deltamap::localization::tracking
