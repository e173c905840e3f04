// SPDX-License-Identifier: Apache-2.0
#include "navigation/free_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.hpp"

namespace deltamap::navigation {
namespace {

constexpr double kRadiusM = 0.3;
constexpr double kMostM = 5.0;
constexpr double kToleranceM = 1e-9;

Scan scan_of(std::size_t beams, BeamKind kind, float range_m) {
  Scan scan;
  scan.first_bearing_rad = -std::numbers::pi / 2.0;
  scan.bearing_step_rad = std::numbers::pi / static_cast<double>(beams - 1);
  scan.max_range_m = 8.0;
  scan.beams.assign(beams, {range_m, 0.0F, kind});
  return scan;
}

TEST(FreePath, EndsWhereTheHullTouchesAPointAhead) {
  EXPECT_NEAR(free_path_m(std::vector<Point2>{{2.0, 0.0}}, 0.0, kRadiusM, kMostM), 1.7, kToleranceM);
  EXPECT_NEAR(free_path_m(std::vector<Point2>{{2.0, 0.18}}, 0.0, kRadiusM, kMostM), 2.0 - 0.24, kToleranceM);
  EXPECT_EQ(free_path_m(std::vector<Point2>{{2.0, 0.31}, {-1.0, 0.0}, {9.0, 0.0}}, 0.0, kRadiusM, kMostM), kMostM);
}

TEST(FreePath, FollowsTheArcToBothSides) {
  // A quarter of a circle of 1 m to the left ends at (1, 1); a point there is touched a chord of 0.3 m before.
  const double touched_m = std::numbers::pi / 2.0 - 2.0 * std::asin(kRadiusM / 2.0);
  EXPECT_NEAR(free_path_m(std::vector<Point2>{{1.0, 1.0}}, 1.0, kRadiusM, kMostM), touched_m, kToleranceM);
  EXPECT_NEAR(free_path_m(std::vector<Point2>{{1.0, -1.0}}, -1.0, kRadiusM, kMostM), touched_m, kToleranceM);
  EXPECT_EQ(free_path_m(std::vector<Point2>{{1.0, -1.0}}, 1.0, kRadiusM, kMostM), kMostM);
}

TEST(FreePath, AgreesWithDrivingTheArcInSmallSteps) {
  Random random{7};
  for (int i = 0; i < 300; ++i) {
    const std::vector<Point2> points{{random.uniform(-2.0, 3.0), random.uniform(-3.0, 3.0)}};
    const double curvature = random.uniform(-2.0, 2.0);
    if (points[0].norm() < kRadiusM) continue;
    double driven_m = 0.0;
    constexpr double kStepM = 0.001;
    for (; driven_m < 3.0; driven_m += kStepM) {
      const double turn = curvature * driven_m;
      const Point2 centre{std::sin(turn) / curvature, (1.0 - std::cos(turn)) / curvature};
      if ((points[0] - centre).norm() < kRadiusM) break;
    }
    EXPECT_NEAR(free_path_m(points, curvature, kRadiusM, 3.0), std::min(driven_m, 3.0), 0.02) << i;
  }
}

TEST(FreePath, LetsARobotThatAlreadyTouchesDriveAway) {
  EXPECT_EQ(free_path_m(std::vector<Point2>{{0.2, 0.1}}, 0.0, kRadiusM, kMostM), 0.0);
  EXPECT_EQ(free_path_m(std::vector<Point2>{{-0.2, 0.1}}, 0.0, kRadiusM, kMostM), kMostM);
  EXPECT_EQ(free_path_m(std::vector<Point2>{{-0.2, 0.1}}, 0.5, kRadiusM, kMostM), kMostM);
}

TEST(Obstacles, AreWhereTheBeamsEndInTheRobotsFrame) {
  Scan scan = scan_of(1, BeamKind::kRange, 2.0F);
  scan.first_bearing_rad = scan.bearing_step_rad = 0.0;
  scan.robot_from_laser = {0.25, 0.0, std::numbers::pi / 2.0};
  const auto obstacles = obstacles_of(scan, {});
  ASSERT_EQ(obstacles.size(), 1u);
  EXPECT_NEAR((obstacles[0] - Point2{0.25, 2.0}).norm(), 0.0, 1e-6);
}

TEST(Obstacles, BeginWhereABeamBeyondTheMaximumIsNoLongerSure) {
  Scan scan = scan_of(181, BeamKind::kBeyondMaximum, 0.0F);
  scan.max_range_m = 2.5;
  EXPECT_NEAR(free_path_m(obstacles_of(scan, {}), 0.0, kRadiusM, kMostM), 2.5 - kRadiusM, 0.01);
}

TEST(Obstacles, CountAGapWhereItIsWideEnoughToHideOne) {
  Scan scan = scan_of(181, BeamKind::kRange, 7.0F);
  scan.beams[90].kind = BeamKind::kNotValid;
  EXPECT_NEAR(nearest_m(obstacles_of(scan, {.hidden_width_m = 0.15})), 7.0,
              1e-6);  // one beam hides 0.15 m only beyond 8 m
  for (std::size_t i = 80; i < 100; ++i) scan.beams[i].kind = i % 2 == 0 ? BeamKind::kDazzled : BeamKind::kNotValid;
  EXPECT_NEAR(nearest_m(obstacles_of(scan, {.hidden_width_m = 0.15})), 0.15 / (20.0 * std::numbers::pi / 180.0), 1e-6);
  EXPECT_EQ(obstacles_of(scan, {}).size(), 181u);
}

TEST(Obstacles, SurroundARobotThatSeesNothingAtAll) {
  const auto obstacles = obstacles_of(scan_of(181, BeamKind::kNotValid, 0.0F), {});
  EXPECT_EQ(free_path_m(obstacles, 0.0, kRadiusM, kMostM), 0.0);
}

}  // namespace
}  // namespace deltamap::navigation
