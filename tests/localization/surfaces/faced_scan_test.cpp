// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/faced_scan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "core/geometry/angle.hpp"
#include "localization/motion/deskew.hpp"

namespace deltamap::localization::surfaces {
namespace {

constexpr double kMaximumM = 8.0;

/// A scan of 181 beams, one a degree, from the origin; `range_m(bearing)`: beyond kMaximumM nothing returns.
Scan scan_of(const std::function<double(double)>& range_m) {
  Scan scan;
  scan.first_bearing_rad = radians(-90.0);
  scan.bearing_step_rad = radians(1.0);
  scan.max_range_m = kMaximumM;
  for (std::size_t i = 0; i <= 180; ++i) {
    const double range = range_m(scan.bearing_rad(i));
    const bool returns = range <= kMaximumM;
    scan.beams.push_back({.range_m = returns ? static_cast<float>(range) : 0.0F,
                          .kind = returns ? BeamKind::kRange : BeamKind::kBeyondMaximum});
  }
  return scan;
}

/// To a face 2 m to the left that ends at x = `end_m`.
double to_left_face(double bearing, double end_m) {
  const double range_m = 2.0 / std::sin(bearing);
  return bearing > 0.0 && range_m * std::cos(bearing) <= end_m ? range_m : 2.0 * kMaximumM;
}

std::vector<Corner> seen_in(const Scan& scan) { return corners_of(scan, motion::deskewed(scan, {})); }

TEST(Corners, LieWhereAFaceEndsAndTheNextBeamsPassBy) {
  for (const double end_m : {1.0, 1.7, 2.6, 3.1}) {
    const std::vector<Corner> corners = seen_in(scan_of([&](double bearing) { return to_left_face(bearing, end_m); }));
    ASSERT_EQ(corners.size(), 1U) << end_m;
    EXPECT_NEAR(corners[0].at.x(), end_m, 2.0 * corners[0].deviation_m) << end_m;
    EXPECT_NEAR(corners[0].at.y(), 2.0, 0.01) << end_m;
    EXPECT_NEAR(corners[0].outward.x(), 1.0, 0.01) << end_m;
    EXPECT_LT(corners[0].deviation_m, 0.06) << end_m;
  }
}

TEST(Corners, AreSeenBeforeAFarWallToo) {
  const auto range_m = [](double bearing) {
    const double far_wall_m = bearing > 0.0 ? 5.0 / std::sin(bearing) : 2.0 * kMaximumM;
    return std::min(far_wall_m, to_left_face(bearing, 1.5));
  };
  const std::vector<Corner> corners = seen_in(scan_of(range_m));
  ASSERT_EQ(corners.size(), 1U);
  EXPECT_NEAR(corners[0].at.x(), 1.5, 2.0 * corners[0].deviation_m);
}

TEST(Corners, AreNoneWhereSomethingNearerHidesTheFace) {
  const auto range_m = [](double bearing) {
    const double face_m = to_left_face(bearing, 100.0);
    return face_m * std::cos(bearing) > 1.5 ? std::min(1.2, face_m) : face_m;
  };
  EXPECT_TRUE(seen_in(scan_of(range_m)).empty());
}

TEST(Corners, AreNoneWhereOneBeamAloneHasNotReturned) {
  Scan scan = scan_of([](double bearing) { return to_left_face(bearing, 3.0); });
  const std::size_t before = seen_in(scan).size();
  scan.beams[150] = {.range_m = 0.0F, .kind = BeamKind::kBeyondMaximum};
  EXPECT_EQ(seen_in(scan).size(), before);
}

TEST(Corners, AreNoneWhereTheFaceMayGoOnUnseen) {
  Scan scan = scan_of([](double bearing) { return to_left_face(bearing, 100.0); });
  EXPECT_TRUE(seen_in(scan).empty()) << "it ends where the laser sees no farther";
  scan = scan_of([](double bearing) { return to_left_face(bearing, 1.5); });
  for (Beam& beam : scan.beams) {
    if (beam.kind == BeamKind::kBeyondMaximum) beam.kind = BeamKind::kDazzled;
  }
  EXPECT_TRUE(seen_in(scan).empty()) << "beams that were dazzled say nothing";
}

TEST(Corners, AreNoneOfThingsTooShortToHaveADirection) {
  const auto range_m = [](double bearing) { return std::abs(bearing) < radians(4.0) ? 2.0 : 2.0 * kMaximumM; };
  EXPECT_TRUE(seen_in(scan_of(range_m)).empty());
}

}  // namespace
}  // namespace deltamap::localization::surfaces
