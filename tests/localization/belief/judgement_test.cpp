// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/judgement.hpp"

#include <gtest/gtest.h>

namespace deltamap::localization::belief {
namespace {

/// What the belief says of a scan without beams, beside a believed place that has no rivals of its own.
Belief belief_with(const hypotheses::HypothesisReport& hypotheses) {
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
                            .hypotheses = hypotheses});
}

TEST(Judgement, HearsOfAWatchedPlaceBesideWhichNoneIsFollowed) {
  hypotheses::HypothesisReport report;
  report.own_known = true;
  report.own_share = 1.0;
  report.followed = 1;
  report.kidnapped_share = 0.4;
  report.map_from_kidnapped = {15.0, 0.0, 0.0};
  const Belief belief = belief_with(report);
  EXPECT_DOUBLE_EQ(belief.other_share, 0.4);
  EXPECT_DOUBLE_EQ(belief.map_from_other.x, 15.0);
}

TEST(Judgement, HearsOfNoPlaceWhereNoneIsKnown) {
  hypotheses::HypothesisReport report;
  report.own_known = true;
  report.own_share = 1.0;
  report.followed = 1;
  EXPECT_DOUBLE_EQ(belief_with(report).other_share, 0.0);
}

}  // namespace
}  // namespace deltamap::localization::belief
