// SPDX-License-Identifier: Apache-2.0
// The paper's hall (Figure 7): 35 × 35 m, four blocks of 10 × 10 m, corridors of 5 m, all alike. The robot circles a
// block with drifting wheels; then containers are taken away and put where the map knows nothing of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "tests/support/scans/cast_scan.hpp"

namespace deltamap::localization {
namespace {

constexpr double kScanPeriodS = 0.2133;  // 38400 baud, 181 values (protocols.md B7)
constexpr double kSpeedMPerS = 0.4;

OccupancyGrid hall() {
  OccupancyGrid map{{720, 720, 0.05, {-0.5, -0.5}}};
  test::fill_box(map, {-0.2, -0.2}, {35.2, 35.2}, CellState::kOccupied);
  test::fill_box(map, {0.0, 0.0}, {35.0, 35.0}, CellState::kFree);
  for (const double x_m : {5.0, 20.0}) {
    for (const double y_m : {5.0, 20.0})
      test::fill_box(map, {x_m, y_m}, {x_m + 10.0, y_m + 10.0}, CellState::kOccupied);
  }
  return map;
}

/// Containers of 2.5 × 2.5 m gone from the blocks' corners and put into the corridors.
OccupancyGrid changed_hall() {
  OccupancyGrid map = hall();
  test::fill_box(map, {12.5, 5.0}, {15.0, 7.5}, CellState::kFree);
  test::fill_box(map, {5.0, 12.5}, {7.5, 15.0}, CellState::kFree);
  test::fill_box(map, {10.0, 5.0}, {12.5, 7.5}, CellState::kFree);
  test::fill_box(map, {20.0, 5.0}, {22.5, 7.5}, CellState::kFree);
  test::fill_box(map, {8.0, 3.5}, {10.5, 5.0}, CellState::kOccupied);
  test::fill_box(map, {18.6, 9.0}, {20.0, 11.5}, CellState::kOccupied);
  test::fill_box(map, {0.0, 8.0}, {1.4, 10.5}, CellState::kOccupied);
  return map;
}

struct Errors {
  std::vector<double> position_m;
  std::size_t tracked = 0;
  [[nodiscard]] double median_m() {
    std::sort(position_m.begin(), position_m.end());
    return position_m[position_m.size() / 2];
  }
  [[nodiscard]] double most_m() const { return *std::max_element(position_m.begin(), position_m.end()); }
};

/// Twice round the lower left block, 30 m... through the middle of the corridors, counter-clockwise.
Errors drive_round(const OccupancyGrid& world, double max_range_m, std::uint64_t seed) {
  LocalizerParams params;
  params.particles.min = 500;
  params.particles.max = 500;
  const Pose2 start{2.5, 2.5, 0.0};
  Localizer localizer{params, std::make_shared<const OccupancyGrid>(hall()), particles::InitialPose{start}, seed};
  Random random{seed + 100};
  Pose2 truth = start;
  Pose2 odom;
  Timestamp time = timestamp_from_ns(1'700'000'000'000'000'000);
  Errors errors;
  const std::vector<Point2> corners{{17.5, 2.5}, {17.5, 17.5}, {2.5, 17.5}, {2.5, 2.5}};
  std::size_t corner = 0;
  while (corner < 2 * corners.size()) {
    const Point2 to = corners[corner % corners.size()] - truth.position();
    if (to.norm() < 0.3) {
      ++corner;
      continue;
    }
    const double off_rad = turn_between(truth.theta, std::atan2(to.y(), to.x()));
    const double turn_rad = std::clamp(off_rad, -0.15, 0.15);
    const double forward_m = std::abs(off_rad) > 0.5 ? 0.0 : kSpeedMPerS * kScanPeriodS;
    truth = truth * Pose2{forward_m, 0.0, turn_rad};
    const double slip = 1.0 + random.normal(0.05);
    odom = odom * Pose2{1.01 * slip * forward_m, 0.0, 1.02 * turn_rad + 0.02 * forward_m + random.normal(0.002)};
    time += duration_from_seconds(kScanPeriodS);
    Odometry odometry;
    odometry.time = time;
    odometry.odom_from_robot = odom;
    localizer.observe(odometry);
    const TrackedScan tracked = localizer.observe(
        test::cast_scan(world, truth, time, {.max_range_m = max_range_m, .noise_m = 0.01, .beams = 181}, random));
    errors.position_m.push_back(distance_between(tracked.estimate.map_from_robot, truth));
    errors.tracked += tracked.estimate.state == LocalizerState::kTracking ? 1 : 0;
  }
  return errors;
}

class Hall : public testing::TestWithParam<std::tuple<double, std::uint64_t>> {};

TEST_P(Hall, IsFollowedWithAMapThatIsTrue) {
  Errors errors = drive_round(hall(), std::get<0>(GetParam()), std::get<1>(GetParam()));
  EXPECT_LT(errors.median_m(), 0.06);
  EXPECT_LT(errors.most_m(), 0.5);
  EXPECT_EQ(errors.tracked, errors.position_m.size());
}

TEST_P(Hall, IsFollowedWhileContainersHaveComeAndGone) {
  Errors errors = drive_round(changed_hall(), std::get<0>(GetParam()), std::get<1>(GetParam()));
  EXPECT_LT(errors.median_m(), 0.10);
  EXPECT_LT(errors.most_m(), 0.5);
  EXPECT_EQ(errors.tracked, errors.position_m.size());
}

INSTANTIATE_TEST_SUITE_P(RangesAndSeeds, Hall, testing::Combine(testing::Values(8.0, 80.0), testing::Values(1u, 2u)));

}  // namespace
}  // namespace deltamap::localization
