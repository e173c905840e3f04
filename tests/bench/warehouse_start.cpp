// SPDX-License-Identifier: Apache-2.0
// A robot that does not know where it is, in a warehouse of so many metres: how long it drives before it is found, and
// what the longest scan costs. `warehouse_start SIDE_M SEED [MAX_RANGE_M]` prints "name value" lines.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <memory>
#include <optional>

#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "tests/support/scans/cast_scan.hpp"

namespace deltamap::bench {
namespace {

constexpr double kCellM = 0.05;
constexpr double kAisleM = 3.0;
constexpr double kBayM = 10.0;  // from one aisle to the next
constexpr double kScanS = 0.2;
constexpr double kSpeedMPerS = 0.5;

double cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void put_container(OccupancyGrid& world, const Point2& low, const Point2& high) {
  const Point2 wall = Point2::Constant(kCellM);
  test::fill_box(world, low, high, CellState::kOccupied);
  test::fill_box(world, low + wall, high - wall, CellState::kUnknown);
}

/// Bays of up to six containers between aisles, three of four places taken; no two bays alike.
OccupancyGrid warehouse(double side_m, Random& random) {
  const int cells = static_cast<int>(std::lround(side_m / kCellM));
  OccupancyGrid world{{cells, cells, kCellM, {0.0, 0.0}}, CellState::kOccupied};
  test::fill_box(world, Point2::Constant(2.0 * kCellM), Point2::Constant(side_m - 2.0 * kCellM), CellState::kFree);
  const int bays = static_cast<int>((side_m - kAisleM) / kBayM);
  for (int place = 0; place < bays * bays * 6; ++place) {
    if (random.uniform() < 0.25) continue;
    const int bay = place / 6;
    const Point2 corner{kAisleM + kBayM * (bay % bays), kAisleM + kBayM * (bay / bays)};
    const Point2 low = corner + Point2{3.6 * (place % 2) + 0.6 * random.uniform(), 2.4 * (place % 6 / 2)};
    put_container(world, low, low + Point2{2.4 + 0.4 * random.uniform(), 1.2 + random.uniform()});
  }
  return world;
}

struct Start {
  std::optional<double> found_s;  ///< nothing: the end of the aisle came first
  double error_m = 0.0;
  double longest_ms = 0.0;
  double mean_ms = 0.0;
};

/// Along an aisle, to its end at most.
Start drive(const OccupancyGrid& world, double side_m, std::uint64_t seed, double max_range_m, Random& random) {
  localization::Localizer localizer{{}, std::make_shared<const OccupancyGrid>(world), std::nullopt, seed};
  const double aisle_y_m = kBayM * (1.0 + std::floor(random.uniform() * (side_m / kBayM - 3.0))) + 0.5 * kAisleM;
  Pose2 truth{2.0 + 0.3 * random.uniform() * side_m, aisle_y_m, 0.0};
  Pose2 odom;
  Start start;
  const Timestamp began = timestamp_from_ns(1'000'000'000'000);
  int scans = 0;
  for (; truth.x < side_m - 4.0; ++scans) {
    const double now_s = kScanS * scans;
    const Pose2 next{truth.x + kSpeedMPerS * kScanS, aisle_y_m + 0.3 * std::sin(0.2 * now_s),
                     0.12 * std::cos(0.2 * now_s)};
    const Pose2 step = motion_between(truth, next);
    truth = next;
    odom = odom * Pose2{1.01 * step.x, step.y, 0.99 * step.theta};  // wheels that are off by a percent
    Odometry odometry;
    odometry.time = began + duration_from_seconds(now_s);
    odometry.odom_from_robot = odom;
    odometry.speed_m_per_s = kSpeedMPerS;
    localizer.observe(odometry);
    Scan scan = test::cast_scan(world, truth, odometry.time, {.max_range_m = max_range_m}, random);
    const double before_s = cpu_s();
    const TrackedScan tracked = localizer.observe(std::move(scan));
    const double taken_ms = 1e3 * (cpu_s() - before_s);
    start.longest_ms = std::max(start.longest_ms, taken_ms);
    start.mean_ms += (taken_ms - start.mean_ms) / (scans + 1);
    if (tracked.estimate.state != LocalizerState::kTracking) continue;
    start.found_s = now_s;
    start.error_m = distance_between(tracked.estimate.map_from_robot, truth);
    break;
  }
  return start;
}

}  // namespace
}  // namespace deltamap::bench

int main(int count, char** words) {
  using namespace deltamap;
  if (count < 3) {
    std::cerr << "usage: warehouse_start SIDE_M SEED [MAX_RANGE_M]\n";
    return 2;
  }
  const double side_m = std::atof(words[1]);
  const auto seed = static_cast<std::uint64_t>(std::atoll(words[2]));
  Random random{seed};
  const OccupancyGrid world = bench::warehouse(side_m, random);
  const bench::Start start = bench::drive(world, side_m, seed, count > 3 ? std::atof(words[3]) : 80.0, random);
  std::cout << "found_s " << start.found_s.value_or(-1.0) << "\nerror_m " << start.error_m << "\nlongest_ms "
            << start.longest_ms << "\nmean_ms " << start.mean_ms << '\n';
  return start.found_s ? 0 : 1;
}
