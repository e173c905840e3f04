// SPDX-License-Identifier: Apache-2.0
// The wheels lose their grip: the robot turns and slides in a way that odometry does not tell.
#include <gtest/gtest.h>

#include <memory>

#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "tests/support/scans/cast_scan.hpp"

namespace deltamap::localization::tracking {
namespace {

constexpr double kScanPeriodS = 0.1067;
constexpr int kSlipsAtStep = 40;

OccupancyGrid corridor() {
  OccupancyGrid map{{220, 440, 0.05, {-0.5, -0.5}}, CellState::kOccupied};
  test::fill_box(map, {0.0, 0.0}, {5.0, 20.0}, CellState::kFree);
  test::fill_box(map, {5.0, 8.0}, {9.0, 10.5}, CellState::kFree);
  return map;
}

/// Mean error of the position over the second after a slip by `slip`.
double error_after_m(const Pose2& slip, std::uint64_t seed) {
  const auto map = std::make_shared<const OccupancyGrid>(corridor());
  Pose2 truth{3.9, 18.0, -std::numbers::pi / 2.0};
  Localizer localizer{{}, map, particles::InitialPose{truth, 0.02, 0.01}, seed};
  Random random{seed + 100};
  Odometry odometry;
  odometry.time = timestamp_from_ns(1'700'000'000'000'000'000);
  double sum_m = 0.0;
  for (int step = 1; step <= kSlipsAtStep + 10; ++step) {
    const Pose2 driven{0.05, 0.0, 0.0};
    truth = truth * driven * (step == kSlipsAtStep ? slip : Pose2{});
    odometry.odom_from_robot = odometry.odom_from_robot * driven;
    odometry.time += duration_from_seconds(kScanPeriodS);
    localizer.observe(odometry);
    const TrackedScan tracked = localizer.observe(test::cast_scan(*map, truth, odometry.time, {}, random));
    if (step > kSlipsAtStep) sum_m += distance_between(tracked.estimate.map_from_robot, truth);
  }
  return sum_m / 10.0;
}

/// Of 600 slips four cost more than 0.025 m: which, and so how many of the first 40, is chance.
TEST(Slip, CostsHardlyASecondOfThePose) {
  int costly = 0;
  double sum_m = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const double side = seed % 2 == 0 ? 1.0 : -1.0;
    const double without_m = error_after_m({}, seed);  // surfaces lie at the cells' edges, the field's at their centres
    for (const Pose2& slip : {Pose2{-0.1, 0.0, side * radians(5.0)}, Pose2{-0.02, 0.0, side * radians(2.5)}}) {
      const double cost_m = error_after_m(slip, seed) - without_m;
      costly += cost_m < 0.025 ? 0 : 1;
      sum_m += cost_m;
    }
  }
  EXPECT_LE(costly, 1);
  EXPECT_LT(sum_m / 40.0, 0.006);
}

}  // namespace
}  // namespace deltamap::localization::tracking
