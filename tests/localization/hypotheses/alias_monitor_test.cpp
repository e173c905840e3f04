// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/alias_monitor.hpp"

#include <gtest/gtest.h>

#include "tests/support/scans/cast_ends.hpp"
#include "tests/support/worlds/symmetric_hall.hpp"

namespace deltamap::localization::hypotheses {
namespace {

const Pose2 kMotion{0.1, 0.0, 0.1};  // of each scan: round a circle of 1 m

/// A robot that drives in circles and knows where it is; the watch beside it.
class WatchedRound {
 public:
  WatchedRound(const OccupancyGrid& map, const OccupancyGrid& world)
      : world_{world}, field_{map, {}}, coarse_{map, field_, 0.25} {}

  void step() {
    truth_ = truth_ * kMotion;
    alias_monitor_.predict(kMotion);
    const motion::BeamEnds ends = test::cast_ends(world_, truth_, {}, random_, 60);
    alias_monitor_.observe({.field = field_,
                            .coarse = coarse_,
                            .ends = ends,
                            .near_ends = ends,
                            .map_from_believed = truth_,
                            .continuous_odom_from_robot = truth_,
                            .stack = stack_});
    stack_.add(ends, truth_);
  }
  [[nodiscard]] std::span<const PoseHypothesis> aliases() const { return alias_monitor_.hypotheses().others(); }

 private:
  const OccupancyGrid& world_;
  Pose2 truth_{6.0, 4.0, 0.0};
  Random random_{2};
  sensor::LikelihoodField field_;
  sensor::CoarseField coarse_;
  ScanStack stack_;
  AliasMonitor alias_monitor_{{.probes = 400, .refined = 4, .prior = 0.003}};
};

TEST(AliasMonitor, HoldsAliasesForAsUnlikelyAsThatSomebodyCarriesRobots) {
  const OccupancyGrid map = test::symmetric_hall();
  WatchedRound round{map, map};
  for (int i = 0; i < 60; ++i) round.step();
  ASSERT_FALSE(round.aliases().empty());
  for (const PoseHypothesis& alias : round.aliases()) EXPECT_DOUBLE_EQ(alias.log_prior, std::log(0.003));
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
