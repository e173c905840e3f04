// SPDX-License-Identifier: Apache-2.0
// Robots that are carried right after their start, a few of `experiment carried`: nothing wrong stays in their maps.
#include <gtest/gtest.h>

#include "experiments/mapping/carried_run.hpp"
#include "tests/support/files/source_tree.hpp"

namespace deltamap::experiments {
namespace {

class Carried : public testing::Test {
 protected:
  Outcome outcome(double carried_after_s, std::uint64_t seed) {
    run.carried_after_s = carried_after_s;
    run.seed = seed;
    return outcome_of(run);
  }

  CarriedRun run{simulation::read_scenario(test::source_path("config/scenarios/room.yaml")), {}};
};

TEST_F(Carried, LeavesNoWallWrongAMinuteAfterAStopAndAStart) {
  std::uint64_t seed = 0;
  for (const double carried_after_s : {1.5, 4.0, 8.0, 20.0}) {
    const Outcome kept = outcome(carried_after_s, ++seed);
    EXPECT_EQ(kept.number("walls_wrong"), 0.0) << carried_after_s;
    EXPECT_EQ(kept.number("ghosts"), 0.0) << carried_after_s;
  }
}

TEST_F(Carried, LeavesNoWallWrongWhereTheSettingsGiveTheOldPoseAgain) {
  run.is_given_again = true;
  EXPECT_EQ(outcome(5.0, 7).number("walls_wrong"), 0.0);
}

}  // namespace
}  // namespace deltamap::experiments
