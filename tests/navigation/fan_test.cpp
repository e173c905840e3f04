// SPDX-License-Identifier: Apache-2.0
#include "navigation/fan.hpp"

#include <gtest/gtest.h>

#include "core/geometry/angle.hpp"

namespace deltamap::navigation {
namespace {

constexpr double kHullAndMarginM = 0.34;

Fan fan(double field_deg, const Pose2& mount) { return {mount, radians(-0.5 * field_deg), radians(field_deg)}; }

TEST(Fan, OfALaserThatLooksAheadCoversTheWay) {
  EXPECT_TRUE(covers_way_ahead(fan(180.0, {0.021, 0.0, 0.0}), kHullAndMarginM));
  EXPECT_TRUE(covers_way_ahead(fan(100.0, {0.021, 0.0, 0.0}), kHullAndMarginM)) << "the narrow field of an LMS 200";
  EXPECT_TRUE(covers_way_ahead(fan(270.0, {0.1, 0.0, radians(45.0)}), kHullAndMarginM));
  EXPECT_TRUE(covers_way_ahead(fan(360.0, {0.0, 0.0, radians(180.0)}), kHullAndMarginM));
}

TEST(Fan, ThatLooksAsideOrBackDoesNot) {
  for (const double yaw_deg : {180.0, 135.0, 90.0, 60.0, -60.0, -90.0, -135.0}) {
    EXPECT_FALSE(covers_way_ahead(fan(180.0, {0.021, 0.0, radians(yaw_deg)}), kHullAndMarginM)) << yaw_deg;
  }
  EXPECT_FALSE(covers_way_ahead(fan(90.0, {0.2, 0.0, 0.0}), kHullAndMarginM)) << "too near to its corners";
  EXPECT_FALSE(covers_way_ahead(fan(180.0, {0.5, 0.0, 0.0}), kHullAndMarginM)) << "ahead of the strip's begin";
}

TEST(Fan, FindsTheBeamThatLooksAtAPoint) {
  Scan scan;
  scan.first_bearing_rad = radians(-90.0);
  scan.bearing_step_rad = radians(1.0);
  scan.beams.resize(181);
  EXPECT_EQ(beam_towards(scan, {2.0, 0.0}), 90u);
  EXPECT_EQ(beam_towards(scan, {0.0, -2.0}), 0u);
  EXPECT_EQ(beam_towards(scan, {0.0, 2.0}), 180u);
  EXPECT_FALSE(beam_towards(scan, {-2.0, 0.1}));
  EXPECT_FALSE(beam_towards(scan, {-2.0, -0.1}));
}

}  // namespace
}  // namespace deltamap::navigation
