// SPDX-License-Identifier: Apache-2.0
#include "localization/motion/deskew.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace deltamap::localization::motion {
namespace {

using std::numbers::pi;
constexpr float kSameInFloat = 1e-5F;

Scan four_beams() {
  Scan scan;
  scan.first_bearing_rad = -pi / 2.0;
  scan.bearing_step_rad = pi / 3.0;
  scan.robot_from_laser = {0.2, 0.0, 0.0};
  scan.beams = {{1.0F, 0.0F, BeamKind::kRange},
                {2.0F, 0.1F, BeamKind::kRange},
                {0.0F, 0.2F, BeamKind::kBeyondMaximum},
                {4.0F, 0.3F, BeamKind::kRange}};
  return scan;
}

TEST(Deskew, PlacesTheEndsOfAStandingRobotByTheMount) {
  const auto rays = deskewed(four_beams(), {});
  ASSERT_EQ(rays.size(), 4u);
  EXPECT_NEAR(rays[0].origin.x(), 0.2F, kSameInFloat);
  EXPECT_NEAR(rays[0].end.x(), 0.2F, kSameInFloat);
  EXPECT_NEAR(rays[0].end.y(), -1.0F, kSameInFloat);
  EXPECT_NEAR(rays[3].end.y(), 4.0F, kSameInFloat);
}

TEST(Deskew, GivesABeamWithoutRangeNoLength) {
  const auto rays = deskewed(four_beams(), {.speed_m_per_s = 1.0});
  EXPECT_EQ(rays[2].origin, rays[2].end);
  EXPECT_NEAR(rays[2].origin.x(), 0.4F, kSameInFloat);
}

TEST(Deskew, PutsEachBeamWhereTheRobotWasThen) {
  const auto rays = deskewed(four_beams(), {.speed_m_per_s = 1.0, .turn_rate_rad_per_s = 1.0});
  const Pose2 then{0.3 * std::cos(0.15), 0.3 * std::sin(0.15), 0.3};
  const Point2 end = then * Point2{0.2, 4.0};
  EXPECT_NEAR(rays[3].end.x(), static_cast<float>(end.x()), kSameInFloat);
  EXPECT_NEAR(rays[3].end.y(), static_cast<float>(end.y()), kSameInFloat);
}

TEST(ScoringEnds, TakesOnlyValidRanges) {
  Scan scan = four_beams();
  scan.range_deviation_m = 0.02;
  const BeamEnds ends = scoring_ends(scan, deskewed(scan, {}), 0);
  EXPECT_EQ(ends.size(), 3u);
  EXPECT_EQ(ends.range_deviation_m, 0.02);
}

TEST(ScoringEnds, TakesAsManyAsAskedEvenly) {
  Scan scan;
  scan.bearing_step_rad = 0.01;
  for (int i = 0; i < 180; ++i) scan.beams.push_back({static_cast<float>(i + 1), 0.0F, BeamKind::kRange});
  const auto rays = deskewed(scan, {});
  for (const int beams : {1, 7, 60, 179, 180, 500}) {
    const BeamEnds ends = scoring_ends(scan, rays, beams);
    EXPECT_EQ(ends.size(), static_cast<std::size_t>(std::min(beams, 180)));
  }
  const BeamEnds every_third = scoring_ends(scan, rays, 60);
  for (std::size_t i = 1; i < every_third.size(); ++i) {
    const double step_m =
        std::hypot(every_third.x_m[i], every_third.y_m[i]) - std::hypot(every_third.x_m[i - 1], every_third.y_m[i - 1]);
    EXPECT_NEAR(step_m, 3.0, 1e-3);
  }
}

TEST(KeepEnds, KeepsOrderAndMayWriteIntoWhatItReads) {
  BeamEnds ends{{1.0F, -2.0F, 3.0F, -4.0F}, {5.0F, 6.0F, 7.0F, 8.0F}, 0.02};
  const auto is_ahead = [](const Point2& end) { return end.x() > 0.0; };
  BeamEnds others{{9.0F}, {9.0F}};
  keep_ends(ends, is_ahead, others);
  EXPECT_EQ(others.x_m, (std::vector<float>{1.0F, 3.0F}));
  EXPECT_EQ(others.y_m, (std::vector<float>{5.0F, 7.0F}));
  EXPECT_EQ(others.range_deviation_m, 0.02);
  keep_ends(ends, is_ahead, ends);
  EXPECT_EQ(ends.x_m, others.x_m);
  EXPECT_EQ(ends.y_m, others.y_m);
}

}  // namespace
}  // namespace deltamap::localization::motion
