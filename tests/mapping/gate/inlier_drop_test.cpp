// SPDX-License-Identifier: Apache-2.0
#include "mapping/gate/inlier_drop.hpp"

#include <gtest/gtest.h>

#include "tests/mapping/straight_drive.hpp"

namespace deltamap::mapping::gate {
namespace {

TEST(InlierDropDetector, CannotBeWorseThanBeforeWhereNothingWasKnownBefore) {
  StraightDrive robot;
  InlierDropDetector inlier_drop{{}};
  inlier_drop.remember();
  for (int i = 0; i < 50; ++i) {
    TrackedScan tracked = robot.next();
    tracked.estimate.belief.elsewhere = {.expected = 100, .fit = 50, .short_of = 50};
    inlier_drop.observe(tracked);
  }
  EXPECT_FALSE(inlier_drop.is_worse_than_remembered());
}

/// After 20 s in which all beams fit and a silence, a scan of which so many of 100 do.
bool is_worse_with(std::uint32_t fit) {
  StraightDrive robot;
  InlierDropDetector inlier_drop{{}};
  for (int i = 0; i < 200; ++i) {
    TrackedScan tracked = robot.next();
    tracked.estimate.belief.elsewhere = {.expected = 100, .fit = 100};
    inlier_drop.observe(tracked);
  }
  inlier_drop.remember();
  for (int i = 0; i < 50; ++i) (void)robot.next();
  TrackedScan tracked = robot.next();
  tracked.estimate.belief.elsewhere = {.expected = 100, .fit = fit, .short_of = 10, .beyond = 90 - fit};
  inlier_drop.observe(tracked);
  return inlier_drop.is_worse_than_remembered();
}

TEST(InlierDropDetector, SeesThatTheMapFitsWorseAfterASilenceToo) {
  EXPECT_TRUE(is_worse_with(60));
  EXPECT_FALSE(is_worse_with(85)) << "a person may hide so much";
}

TEST(InlierDropDetector, HearsNothingFromAFewBeams) {
  StraightDrive robot;
  InlierDropDetector inlier_drop{{}};
  const auto observe = [&](std::uint32_t expected, std::uint32_t short_of) {
    TrackedScan tracked = robot.next();
    tracked.estimate.belief.elsewhere = {.expected = expected, .fit = expected - short_of, .short_of = short_of};
    inlier_drop.observe(tracked);
  };
  for (int i = 0; i < 200; ++i) observe(100, 0);
  inlier_drop.remember();
  for (int i = 0; i < 50; ++i) observe(29, 29);
  EXPECT_FALSE(inlier_drop.is_worse_than_remembered());
  for (int i = 0; i < 10; ++i) observe(30, 30);
  EXPECT_TRUE(inlier_drop.is_worse_than_remembered());
}

}  // namespace
}  // namespace deltamap::mapping::gate
