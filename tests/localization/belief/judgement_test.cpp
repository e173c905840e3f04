// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/judgement.hpp"

#include <gtest/gtest.h>

namespace deltamap::localization::belief {
namespace {

/// What the belief says of a scan without beams, beside a believed place that has no rivals of its own.
Belief belief_with(const hypotheses::RivalReport& rivals) {
  const OccupancyGrid map{GridGeometry{20, 20, 0.1, {0.0, 0.0}}, CellState::kFree};
  Judgement judgement{map, {}};
  judgement.start(0.9);
  const Scan scan;
  const sensor::RefinedPose believed{};
  return judgement.observe({.map = map,
                            .scan = scan,
                            .rays = {},
                            .believed = believed,
                            .state = LocalizerState::kTracking,
                            .passed = {},
                            .rivals = rivals});
}

TEST(Judgement, HearsOfAWatchedPlaceBesideWhichNoneIsFollowed) {
  hypotheses::RivalReport report;
  report.own_known = true;
  report.own_share = 1.0;
  report.places = 1;
  report.carried_share = 0.4;
  report.map_from_carried = {15.0, 0.0, 0.0};
  const Belief belief = belief_with(report);
  EXPECT_DOUBLE_EQ(belief.rival_share, 0.4);
  EXPECT_DOUBLE_EQ(belief.map_from_rival.x, 15.0);
}

TEST(Judgement, HearsOfNoPlaceWhereNoneIsKnown) {
  hypotheses::RivalReport report;
  report.own_known = true;
  report.own_share = 1.0;
  report.places = 1;
  EXPECT_DOUBLE_EQ(belief_with(report).rival_share, 0.0);
}

}  // namespace
}  // namespace deltamap::localization::belief
