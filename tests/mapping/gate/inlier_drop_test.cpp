// SPDX-License-Identifier: Apache-2.0
#include "mapping/gate/inlier_drop.hpp"

#include <gtest/gtest.h>

#include "tests/mapping/straight_drive.hpp"

namespace deltamap::mapping::gate {
namespace {

/// So many scans, all with these beams.
void show(StraightDrive& robot, InlierDropDetector& inlier_drop, const BeamCounts& beams, int scans = 1) {
  for (int i = 0; i < scans; ++i) {
    TrackedScan tracked = robot.next();
    tracked.estimate.belief.elsewhere = beams;
    inlier_drop.observe(tracked);
  }
}

TEST(InlierDropDetector, CannotBeWorseThanBeforeWhereNothingWasKnownBefore) {
  StraightDrive robot;
  InlierDropDetector inlier_drop;
  inlier_drop.remember();
  show(robot, inlier_drop, {.expected = 100, .fit = 50, .short_of = 50}, 50);
  EXPECT_FALSE(inlier_drop.is_worse_than_remembered());
}

/// After 20 s in which all beams fit and a silence, a scan of which so many of 100 do.
bool is_worse_with(std::uint32_t fit) {
  StraightDrive robot;
  InlierDropDetector inlier_drop;
  show(robot, inlier_drop, {.expected = 100, .fit = 100}, 200);
  inlier_drop.remember();
  for (int i = 0; i < 50; ++i) (void)robot.next();
  show(robot, inlier_drop, {.expected = 100, .fit = fit, .short_of = 10, .beyond = 90 - fit});
  return inlier_drop.is_worse_than_remembered();
}

TEST(InlierDropDetector, SeesThatTheMapFitsWorseAfterASilenceToo) {
  EXPECT_TRUE(is_worse_with(60));
  EXPECT_FALSE(is_worse_with(85)) << "a person may hide so much";
}

TEST(InlierDropDetector, HearsNothingFromAFewBeams) {
  StraightDrive robot;
  InlierDropDetector inlier_drop;
  show(robot, inlier_drop, {.expected = 100, .fit = 100}, 200);
  inlier_drop.remember();
  show(robot, inlier_drop, {.expected = 29, .short_of = 29}, 50);
  EXPECT_FALSE(inlier_drop.is_worse_than_remembered());
  show(robot, inlier_drop, {.expected = 30, .short_of = 30}, 10);
  EXPECT_TRUE(inlier_drop.is_worse_than_remembered());
}

}  // namespace
}  // namespace deltamap::mapping::gate
