// SPDX-License-Identifier: Apache-2.0
// A robot that drives where the map knows nothing, or where nothing that it knows is in view.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "tests/support/scans/cast_scan.hpp"
#include "tests/support/worlds/symmetric_hall.hpp"

namespace deltamap::localization {
namespace {

constexpr double kScanPeriodS = 0.2;

/// A robot that begins at a pose that the localizer is given, and is moved from scan to scan.
class Walk {
 public:
  Walk(OccupancyGrid world, const OccupancyGrid& map, const Pose2& begin, double max_range_m, std::uint64_t seed,
       const LocalizerParams& params = small())
      : world_{std::move(world)},
        localizer_{params, std::make_shared<const OccupancyGrid>(map), particles::InitialPose{begin}, 1},
        scanner_{.max_range_m = max_range_m},
        random_{seed},
        truth_{begin} {
    odometry_.time = timestamp_from_ns(1'700'000'000'000'000'000);
  }

  Estimate next(const Pose2& motion) { return next(motion, motion); }
  Estimate next(const Pose2& motion, const Pose2& counted) {
    truth_ = truth_ * motion;
    odometry_.time += duration_from_seconds(kScanPeriodS);
    odometry_.odom_from_robot = odometry_.odom_from_robot * counted;
    localizer_.observe(odometry_);
    return localizer_.observe(test::cast_scan(world_, truth_, odometry_.time, scanner_, random_)).estimate;
  }
  void carry_to(const Pose2& place) { truth_ = place; }

  [[nodiscard]] Localizer& localizer() { return localizer_; }
  [[nodiscard]] const Pose2& truth() const { return truth_; }

  static LocalizerParams small() {
    LocalizerParams params;
    params.particles.min = 300;
    params.particles.max = 3000;
    return params;
  }

 private:
  OccupancyGrid world_;
  Localizer localizer_;
  test::CastScanner scanner_;
  Random random_;
  Pose2 truth_;
  Odometry odometry_;
};

OccupancyGrid hall_with_an_unknown_quarter() {
  OccupancyGrid map = test::symmetric_hall();
  test::fill_box(map, {6.0, -1.0}, {13.0, 6.0}, CellState::kUnknown);
  return map;
}

/// Straight on, and back after half a turn in thirty scans.
Pose2 there_and_back(int scan, int turns_at) {
  const bool turns = scan >= turns_at && scan < turns_at + 30;
  return turns ? Pose2{0.0, 0.0, std::numbers::pi / 30.0} : Pose2{0.1, 0.0, 0.0};
}

/// Along the lower side of a hall whose quarters look alike, there and back; the laser sees 4 m.
TEST(UnmappedSpace, IsNoReasonToBeBelievedElsewhere) {
  Walk walk{test::symmetric_hall(), hall_with_an_unknown_quarter(), {1.0, 1.0, 0.0}, 4.0, 3};
  Pose2 believed;
  for (int i = 0; i < 230; ++i) {
    const Estimate estimate = walk.next(there_and_back(i, 100));
    ASSERT_EQ(estimate.state, LocalizerState::kTracking) << i;
    believed = estimate.map_from_robot;
    ASSERT_LT(distance_between(believed, walk.truth()), 0.3) << i;
  }
  EXPECT_LT(distance_between(believed, walk.truth()), 0.1);
}

/// Out of a room of 4 × 4 m into a corridor that nobody has mapped, and back, on wheels that count and turn too much.
TEST(UnmappedSpace, IsLeftForASmallRoom) {
  OccupancyGrid world{{420, 140, 0.05, {-1.0, -1.0}}};
  test::fill_box(world, {-0.2, -0.2}, {4.2, 4.2}, CellState::kOccupied);
  test::fill_box(world, {0.0, 0.0}, {4.0, 4.0}, CellState::kFree);
  test::fill_box(world, {0.0, 2.8}, {0.8, 4.0}, CellState::kOccupied);
  OccupancyGrid map = world;
  test::fill_box(world, {4.0, 0.8}, {18.2, 3.2}, CellState::kOccupied);
  test::fill_box(world, {4.0, 1.0}, {18.0, 3.0}, CellState::kFree);
  test::fill_box(map, {4.0, 1.0}, {4.2, 3.0}, CellState::kFree);
  Walk walk{world, map, {1.0, 2.0, 0.0}, 8.0, 9};
  Pose2 believed;
  for (int i = 0; i < 310; ++i) {
    const Pose2 motion = there_and_back(i, 140);
    believed = walk.next(motion, {1.02 * motion.x, 0.0, 1.02 * motion.theta + 0.01 * motion.x}).map_from_robot;
    const double fit_of_all = walk.localizer().fit_of_all().value();
    EXPECT_TRUE(i != 0 || fit_of_all > 0.8) << fit_of_all;
    EXPECT_TRUE(i != 139 || fit_of_all < 0.1) << fit_of_all << " speaks for a pose that is held";
  }
  EXPECT_LT(distance_between(believed, walk.truth()), 0.1);
}

TEST(UnmappedSpace, IsForgottenWhereTheRobotIsRelocalized) {
  Walk walk{test::symmetric_hall(), hall_with_an_unknown_quarter(), {10.0, 1.0, 0.0}, 4.0, 3};
  for (int i = 0; i < 5; ++i) (void)walk.next({});
  const Pose2 elsewhere{1.0, 1.0, 0.0};
  walk.carry_to(elsewhere);
  walk.localizer().relocalize(particles::InitialPose{elsewhere});
  (void)walk.next({});
  EXPECT_GT(walk.localizer().fit().value_or(0.0), 0.9);
}

/// The wheels turn at a wall, and no scan comes meanwhile: the pose that they tell of lies behind the wall, where the
/// map knows nothing, and all beams would be left out.
TEST(UnmappedSpace, IsNoExcuseForAPoseThatHasGoneThroughAWall) {
  OccupancyGrid map{{200, 200, 0.05, {-1.0, -1.0}}};
  test::fill_box(map, {-0.2, -0.2}, {4.2, 4.2}, CellState::kOccupied);
  test::fill_box(map, {0.0, 0.0}, {4.0, 4.0}, CellState::kFree);
  test::fill_box(map, {2.8, 0.0}, {3.2, 0.6}, CellState::kOccupied);
  Walk walk{map, map, {3.4, 2.0, 0.0}, 8.0, 7};
  for (int i = 0; i < 10; ++i) (void)walk.next({});
  (void)walk.next({}, {2.0, 0.0, 0.0});
  EXPECT_TRUE(walk.localizer().fit().has_value());
}

/// Carried from a small room into a hall: by its wheels the robot leaves the room for a corridor that nobody has
/// mapped.
TEST(UnmappedSpace, IsNoHidingPlaceForARobotThatWasCarried) {
  OccupancyGrid map{{560, 200, 0.05, {-1.0, -1.0}}};
  test::fill_box(map, {-0.2, -0.2}, {4.2, 4.2}, CellState::kOccupied);
  test::fill_box(map, {0.0, 0.0}, {4.0, 4.0}, CellState::kFree);
  test::fill_box(map, {4.0, 1.0}, {4.2, 3.0}, CellState::kFree);
  test::fill_box(map, {13.8, -0.2}, {26.2, 8.2}, CellState::kOccupied);
  test::fill_box(map, {14.0, 0.0}, {26.0, 8.0}, CellState::kFree);
  test::fill_box(map, {19.0, 5.5}, {21.0, 8.0}, CellState::kOccupied);
  LocalizerParams slow = Walk::small();
  slow.hypothesis_tracker.probes = 0;
  slow.global.alone.candidates = 4000;
  slow.global.beside.candidates = 800;
  Walk walk{map, map, {1.0, 2.0, 0.0}, 8.0, 9, slow};
  for (int i = 0; i < 60; ++i) (void)walk.next({0.01, 0.0, 0.0});
  walk.carry_to({15.0, 3.0, 0.2});
  Estimate estimate;
  int beyond = 0;
  for (int i = 0; i < 75; ++i) {
    estimate = walk.next(there_and_back(i, 50));
    ASSERT_EQ(estimate.state, LocalizerState::kTracking) << i;
    if (estimate.map_from_robot.x < 4.5) continue;
    ++beyond;
    EXPECT_TRUE(walk.localizer().fit().has_value()) << i;
  }
  EXPECT_GT(beyond, 40);
  EXPECT_LT(distance_between(estimate.belief.map_from_other, walk.truth()), 0.1);
  EXPECT_GT(estimate.belief.other_share, 0.5);
}

/// Along a corridor of which the map shows the first metres alone, until the wheels may be off by metres.
TEST(UnmappedSpace, IsLeftOutOnlyWhileTheWheelsTellWhereTheRobotIs) {
  OccupancyGrid world{{4200, 100, 0.05, {-1.0, -1.0}}};
  test::fill_box(world, {-0.2, -0.2}, {206.0, 3.2}, CellState::kOccupied);
  test::fill_box(world, {0.0, 0.0}, {205.0, 3.0}, CellState::kFree);
  OccupancyGrid map = world;
  test::fill_box(map, {6.0, -1.0}, {208.0, 4.0}, CellState::kUnknown);
  Walk walk{world, map, {1.0, 1.5, 0.0}, 4.0, 11};
  int blind = 0;
  double sigma_m = 0.0;
  bool is_held = false;
  for (int i = 0; i < 200 && !is_held; ++i) {
    const Estimate estimate = walk.next({0.2, 0.0, 0.0});
    ASSERT_EQ(estimate.state, LocalizerState::kTracking) << i;
    is_held = walk.truth().x > 10.0 && walk.localizer().fit().has_value();
    ASSERT_TRUE(!is_held || sigma_m > 0.7) << i;
    blind += walk.truth().x > 10.0 && !is_held ? 1 : 0;
    sigma_m = std::sqrt(estimate.covariance.topLeftCorner<2, 2>().trace());
  }
  EXPECT_TRUE(is_held);
  EXPECT_GT(blind, 2);
}

/// From a corner into the middle of a hall, where only a post stands that the map does not have; the laser sees 4 m.
TEST(NothingInView, LeavesThePoseAsSureAsTheWheels) {
  OccupancyGrid map{{500, 500, 0.05, {-0.5, -0.5}}};
  test::fill_box(map, {-0.2, -0.2}, {24.2, 24.2}, CellState::kOccupied);
  test::fill_box(map, {0.0, 0.0}, {24.0, 24.0}, CellState::kFree);
  OccupancyGrid world = map;
  test::fill_box(world, {8.0, 9.0}, {8.3, 9.3}, CellState::kOccupied);
  Walk walk{world, map, {2.0, 2.0, radians(45.0)}, 4.0, 5};
  double before_m = 0.0;
  for (int i = 0; i < 100; ++i) {
    const Estimate estimate = walk.next({0.08, 0.0, i < 20 ? 0.0 : 0.002});
    const double sigma_m = std::sqrt(estimate.covariance(0, 0));
    ASSERT_TRUE(i < 10 || sigma_m < before_m + 0.05) << i;
    before_m = sigma_m;
    ASSERT_LT(distance_between(estimate.map_from_robot, walk.truth()), 0.25) << i;
  }
}

}  // namespace
}  // namespace deltamap::localization
