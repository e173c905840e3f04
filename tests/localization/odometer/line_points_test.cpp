// SPDX-License-Identifier: Apache-2.0
#include "localization/odometer/line_points.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "localization/motion/deskew.hpp"

namespace deltamap::localization::odometer {
namespace {

/// From the origin, one beam a degree, of a wall 2 m to the left whose ends have noise.
Scan wall_to_the_left(double noise_m) {
  Scan scan;
  scan.first_bearing_rad = radians(-90.0);
  scan.bearing_step_rad = radians(1.0);
  scan.max_range_m = 8.0;
  Random random{3};
  for (std::size_t i = 0; i <= 180; ++i) {
    const double bearing = scan.bearing_rad(i);
    const double range_m = 2.0 / std::sin(bearing);
    const bool returns = bearing > 0.0 && range_m < 4.0;
    scan.beams.push_back({.range_m = returns ? static_cast<float>(range_m + random.normal(noise_m)) : 0.0F,
                          .kind = returns ? BeamKind::kRange : BeamKind::kBeyondMaximum});
  }
  return scan;
}

TEST(LinePoints, LieOnTheWallWithItsNormalTowardsTheLaser) {
  const Scan scan = wall_to_the_left(0.01);
  LinePointFinder finder;
  double squares_m2 = 0.0;
  std::size_t lines = 0;
  for (const LinePoint& point : finder.points_of(scan, motion::deskewed(scan, {}))) {
    if (!point.has_line()) continue;
    ++lines;
    squares_m2 += std::pow(point.at.y() - 2.0F, 2.0F);
    EXPECT_LT(point.normal.y(), -0.95F);
    EXPECT_NEAR(point.normal.norm(), 1.0F, 1e-5F);
  }
  EXPECT_GE(lines, 55U);                                                 // of 60 beams
  EXPECT_LT(std::sqrt(squares_m2 / static_cast<double>(lines)), 0.006);  // half of the ranges' noise
}

TEST(LinePoints, AreNoLineAcrossAGapOfRange) {
  Scan scan = wall_to_the_left(0.0);
  for (std::size_t i = 0; i < scan.beams.size(); i += 2) {
    if (scan.beams[i].kind == BeamKind::kRange) scan.beams[i].range_m += 1.5F;
  }
  LinePointFinder finder;
  for (const LinePoint& point : finder.points_of(scan, motion::deskewed(scan, {}))) EXPECT_FALSE(point.has_line());
}

TEST(LinePoints, OfABlindScanAreNone) {
  Scan scan = wall_to_the_left(0.0);
  for (Beam& beam : scan.beams) beam = {.kind = BeamKind::kBeyondMaximum};
  LinePointFinder finder;
  EXPECT_TRUE(finder.points_of(scan, motion::deskewed(scan, {})).empty());
}

}  // namespace
}  // namespace deltamap::localization::odometer
