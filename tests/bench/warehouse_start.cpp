// SPDX-License-Identifier: Apache-2.0
// A robot that does not know where it is, in a warehouse of so many metres or in a building of corridors a kilometre
// long: how long it drives before it is found, and what the longest scan costs. `warehouse_start SIDE_M|corridors SEED
// [MAX_RANGE_M]` prints "name value" lines.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

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

/// Where a robot drives, to the right.
struct Way {
  OccupancyGrid world;
  Point2 begin;
  double end_x_m;
};

Way warehouse_way(double side_m, Random& random) {
  OccupancyGrid world = warehouse(side_m, random);
  const double aisle_y_m = kBayM * (1.0 + std::floor(random.uniform() * (side_m / kBayM - 3.0))) + 0.5 * kAisleM;
  return {std::move(world), {2.0 + 0.3 * random.uniform() * side_m, aisle_y_m}, side_m - 4.0};
}

/// Corridors beside each other with doors in their walls, 0.1 m back, one every 3 to 7 m; each fourth stands open, and
/// a room lies behind it. A crossing every 60 to 140 m. Nothing else tells one place from another.
Way corridors_way(Random& random) {
  constexpr double kLongM = 1000.0;
  constexpr double kApartM = 12.0;
  constexpr double kWideM = 2.4;
  constexpr int kCorridors = 8;
  const double deep_m = kApartM * kCorridors;
  OccupancyGrid world{{static_cast<int>(kLongM / kCellM), static_cast<int>(deep_m / kCellM), kCellM, {0.0, 0.0}},
                      CellState::kUnknown};
  const auto open = [&](const Point2& low, const Point2& high) {
    const Point2 wall = Point2::Constant(kCellM);
    test::fill_box(world, low - wall, high + wall, CellState::kOccupied);
    return std::pair{low, high};
  };
  std::vector<std::pair<Point2, Point2>> floors;
  for (double x = 30.0; x < kLongM - 10.0; x += random.uniform(60.0, 140.0))
    floors.push_back(open({x, 2.0}, {x + kWideM, deep_m - 2.0}));
  for (int corridor = 0; corridor < kCorridors; ++corridor) {
    const double y = kApartM * (corridor + 0.5) - 0.5 * kWideM;
    floors.push_back(open({2.0, y}, {kLongM - 2.0, y + kWideM}));
    for (const double to : {-1.0, 1.0}) {  // a wall of it
      const double wall_y = y + (to < 0.0 ? 0.0 : kWideM);
      const auto open_beyond = [&](double x, double wide_m, double from_m, double deep) {
        const auto [low_y, high_y] = std::minmax({wall_y + to * from_m, wall_y + to * (from_m + deep)});
        floors.push_back(open({x, low_y}, {x + wide_m, high_y}));
      };
      for (double x = 8.0; x < kLongM - 12.0; x += random.uniform(3.0, 7.0)) {
        open_beyond(x, 0.9, 0.0, 0.1);
        if (random.index_below(4) > 0) continue;
        open_beyond(x, 0.9, 0.1, 0.1);
        open_beyond(x - random.uniform(0.2, 1.5), 2.8, 0.2, random.uniform(2.0, 4.0));
      }
    }
  }
  for (const auto& [low, high] : floors) test::fill_box(world, low, high, CellState::kFree);
  const double y = kApartM * (random.index_below(kCorridors) + 0.5);
  return {std::move(world), {random.uniform(100.0, 600.0), y}, kLongM - 10.0};
}

struct Start {
  std::optional<double> found_s;  ///< nothing: the end of the aisle came first
  double error_m = 0.0;
  double longest_ms = 0.0;
  double mean_ms = 0.0;
};

/// To the end of the way at most.
Start drive(const Way& way, std::uint64_t seed, double max_range_m, Random& random) {
  localization::Localizer localizer{{}, std::make_shared<const OccupancyGrid>(way.world), std::nullopt, seed};
  Pose2 truth{way.begin.x(), way.begin.y(), 0.0};
  Pose2 odom;
  Start start;
  const Timestamp began = timestamp_from_ns(1'000'000'000'000);
  int scans = 0;
  for (; truth.x < way.end_x_m; ++scans) {
    const double now_s = kScanS * scans;
    const Pose2 next{truth.x + kSpeedMPerS * kScanS, way.begin.y() + 0.3 * std::sin(0.2 * now_s),
                     0.12 * std::cos(0.2 * now_s)};
    const Pose2 step = motion_between(truth, next);
    truth = next;
    odom = odom * Pose2{1.01 * step.x, step.y, 0.99 * step.theta};  // wheels that are off by a percent
    Odometry odometry;
    odometry.time = began + duration_from_seconds(now_s);
    odometry.odom_from_robot = odom;
    odometry.speed_m_per_s = kSpeedMPerS;
    localizer.observe(odometry);
    Scan scan = test::cast_scan(way.world, truth, odometry.time, {.max_range_m = max_range_m}, random);
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
    std::cerr << "usage: warehouse_start SIDE_M|corridors SEED [MAX_RANGE_M]\n";
    return 2;
  }
  const auto seed = static_cast<std::uint64_t>(std::atoll(words[2]));
  Random random{seed};
  const bench::Way way = std::string_view{words[1]} == "corridors" ? bench::corridors_way(random)
                                                                   : bench::warehouse_way(std::atof(words[1]), random);
  const bench::Start start = bench::drive(way, seed, count > 3 ? std::atof(words[3]) : 80.0, random);
  std::cout << "found_s " << start.found_s.value_or(-1.0) << "\nerror_m " << start.error_m << "\nlongest_ms "
            << start.longest_ms << "\nmean_ms " << start.mean_ms << '\n';
  return start.found_s ? 0 : 1;
}
