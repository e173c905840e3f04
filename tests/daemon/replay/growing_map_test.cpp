// SPDX-License-Identifier: Apache-2.0
// A robot drives into a wing that its map leaves out, and comes back: the map grows as it goes, and what it knew before
// stays where it is.
#include <gtest/gtest.h>

#include <memory>
#include <numbers>

#include "daemon/replay/sequential_run.hpp"
#include "tests/support/scans/cast_scan.hpp"

namespace deltamap::daemon {
namespace {

constexpr double kPeriodS = 0.2;
constexpr double kWingFromX = 12.5;
const Pose2 kStart{3.0, 3.0, 0.0};

/// Two halls of 12 × 14 m with boxes, two doors between them.
OccupancyGrid building() {
  OccupancyGrid world{{520, 300, 0.05, {-0.5, -0.5}}};
  test::fill_box(world, {-0.2, -0.2}, {25.0, 14.2}, CellState::kOccupied);
  test::fill_box(world, {0.0, 0.0}, {12.0, 14.0}, CellState::kFree);
  test::fill_box(world, {12.2, 0.0}, {24.8, 14.0}, CellState::kFree);
  for (const double door_y : {2.0, 10.0}) test::fill_box(world, {11.9, door_y}, {12.3, door_y + 2.0}, CellState::kFree);
  for (const Point2& corner :
       {Point2{6.0, 5.0}, Point2{8.5, 8.0}, Point2{5.5, 0.0}, Point2{0.0, 7.0}, Point2{16.0, 5.5}, Point2{18.2, 7.3},
        Point2{23.6, 1.0}, Point2{14.0, 0.0}, Point2{21.0, 12.8}}) {
    test::fill_box(world, corner, corner + Point2{1.3, 1.1}, CellState::kOccupied);
  }
  return world;
}

/// Once round through both doors: straight on by 12 cm a scan, and at each corner a quarter turn on the spot.
class Round {
 public:
  [[nodiscard]] Pose2 next() {
    if (turned_ > 0) {
      --turned_;
      return {0.0, 0.0, std::numbers::pi / 2.0 / kTurns};
    }
    driven_m_ += kStepM;
    if (driven_m_ >= (side_ % 2 == 0 ? 17.0 : 8.0)) {
      driven_m_ = 0.0;
      turned_ = kTurns;
      ++side_;
    }
    return {kStepM, 0.0, 0.0};
  }
  [[nodiscard]] int sides() const { return side_; }

 private:
  static constexpr double kStepM = 0.12;
  static constexpr int kTurns = 18;
  double driven_m_ = 0.0;
  int turned_ = 0;
  int side_ = 0;
};

/// What came of a drive on wheels that turn too much by 2° a metre and by 6 % of each turn.
struct Grown {
  OccupancyGrid begun_with;
  OccupancyGrid map;
  double farthest_off_m = 0.0;
  double last_off_m = 0.0;
  double wheels_off_m = 0.0;
  int told = 0;  // lines about the ground
};

Grown grown_over(int sides) {
  const OccupancyGrid world = building();
  OccupancyGrid known = world;
  test::fill_box(known, {kWingFromX, -1.0}, {26.0, 15.0}, CellState::kUnknown);
  Settings settings;
  settings.initial_pose = kStart;
  SequentialRun run{settings, {std::make_shared<const OccupancyGrid>(known)}, nullptr, 0.3};
  Grown grown{known, known};
  Random random{3};
  Pose2 truth = kStart;
  Odometry odometry;
  odometry.time = timestamp_from_ns(1'700'000'000'000'000'000);
  Round round;
  while (round.sides() < sides) {
    const Pose2 motion = round.next();
    truth = truth * motion;
    odometry.time += duration_from_seconds(kPeriodS);
    odometry.odom_from_robot =
        odometry.odom_from_robot * Pose2{1.02 * motion.x, 0.0, 1.06 * motion.theta + radians(2.0) * motion.x};
    run.observe(odometry);
    Scan scan = test::cast_scan(world, truth, odometry.time, {.max_range_m = 30.0}, random);
    run.take_what_is_due(scan);
    const TrackedScan tracked = run.observe(std::move(scan));
    grown.told += static_cast<int>(run.localization().lines().size());
    if (const auto request = run.look_for_changes(tracked)) (void)run.update_map(*request);
    grown.last_off_m = distance_between(tracked.estimate.map_from_robot, truth);
    grown.farthest_off_m = std::max(grown.farthest_off_m, grown.last_off_m);
    grown.map = *tracked.estimate.map;
  }
  grown.wheels_off_m = distance_between(kStart * odometry.odom_from_robot, truth);
  return grown;
}

TEST(GrowingMap, CarriesThePoseThroughAWingThatTheMapLeavesOut) {
  const Grown grown = grown_over(7);
  EXPECT_GT(grown.wheels_off_m, 3.0) << "the drive asks nothing";
  EXPECT_LT(grown.farthest_off_m, 0.25);
  EXPECT_LT(grown.last_off_m, 0.1);
  EXPECT_EQ(grown.told, 4) << "twice into the wing and back";
  const OccupancyGrid world = building();
  std::size_t walls = 0, drawn = 0, known = 0, kept = 0;
  for_each_known(world, [&](Cell cell, CellState state) {
    const Cell there = grown.map.geometry().cell_at(world.geometry().centre_of(cell));
    if (grown.begun_with[cell] != CellState::kUnknown) {
      ++known;
      kept += grown.map.at(there) == state ? 1 : 0;
    } else if (state == CellState::kFree) {
      ++walls;
      drawn += grown.map.at(there) == CellState::kFree ? 1 : 0;
    }
  });
  EXPECT_GT(static_cast<double>(kept), 0.995 * static_cast<double>(known)) << "what was known stays";
  EXPECT_GT(static_cast<double>(drawn), 0.7 * static_cast<double>(walls)) << "the wing is drawn";
}

}  // namespace
}  // namespace deltamap::daemon
