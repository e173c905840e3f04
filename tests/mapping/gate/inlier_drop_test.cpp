// SPDX-License-Identifier: Apache-2.0
#include "mapping/gate/inlier_drop.hpp"

#include <gtest/gtest.h>

#include "tests/mapping/straight_drive.hpp"

namespace deltamap::mapping::gate {
namespace {

TEST(InlierDropDetector, CannotBeWorseThanBeforeWhereNothingWasKnownBefore) {
  StraightDrive robot;
  InlierDropDetector misfit{{}};
  misfit.remember();
  for (int i = 0; i < 50; ++i) {
    TrackedScan tracked = robot.next();
    tracked.estimate.belief.elsewhere = {.expected = 100, .fit = 50, .short_of = 50};
    misfit.observe(tracked);
  }
  EXPECT_FALSE(misfit.is_worse_than_remembered(0.0));
}

TEST(InlierDropDetector, SeesThatTheMapFitsWorseAfterASilenceToo) {
  StraightDrive robot;
  InlierDropDetector misfit{{}};
  for (int i = 0; i < 200; ++i) {
    TrackedScan tracked = robot.next();
    tracked.estimate.belief.elsewhere = {.expected = 100, .fit = 100};
    misfit.observe(tracked);
  }
  misfit.remember();
  for (int i = 0; i < 50; ++i) (void)robot.next();
  TrackedScan tracked = robot.next();
  tracked.estimate.belief.elsewhere = {.expected = 100, .fit = 60, .short_of = 20, .beyond = 20};
  misfit.observe(tracked);
  EXPECT_TRUE(misfit.is_worse_than_remembered(0.0));
  EXPECT_FALSE(misfit.is_worse_than_remembered(0.3));
}

}  // namespace
}  // namespace deltamap::mapping::gate
