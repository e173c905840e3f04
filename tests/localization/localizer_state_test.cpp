// SPDX-License-Identifier: Apache-2.0
// How a pose comes to be believed and ceases to be, through the front door. Beams that the map says nothing about, and
// poses behind a wall: unmapped_space_test.cpp.
#include "localization/localizer_state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "tests/localization/hall_tour.hpp"

namespace deltamap::localization::tour_test {
namespace {

Scan blind(Scan scan) {
  for (Beam& beam : scan.beams) beam = Beam{};
  return scan;
}

TEST(GivenPose, IsBelievedFromTheFirstScanOn) {
  Tour tour{1};
  Localizer localizer = localizer_at(particles::InitialPose{tour.truth()}, 1);
  EXPECT_EQ(tour.next(localizer).estimate.state, LocalizerState::kTracking);
  EXPECT_EQ(localizer.counts().poses_confirmed, 0u) << "nothing had to be";
  EXPECT_EQ(localizer.counts().searches, 0u);
}

TEST(GivenPose, InsideAContainerIsMovedBesideItAndChecked) {
  Tour tour{1};
  tour.carry_to({8.0, 3.0, 0.0});
  Localizer localizer = localizer_at(particles::InitialPose{{9.2, 3.0, 0.0}, 0.4}, 1);
  EXPECT_EQ(localizer.counts().poses_in_obstacle, 1u);
  EXPECT_NE(tour.next(localizer).estimate.state, LocalizerState::kTracking);
  EXPECT_LT(scans_until_right(localizer, tour, 300), 300);
}

TEST(GivenPose, OutsideTheMapOrOfNoNumberMeansThatTheWholeMapIsSearched) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Pose2& nonsense : {Pose2{-50.0, 3.0, 0.0}, Pose2{1e300, 0.0, 0.0}, Pose2{nan, 3.0, 0.0}}) {
    Tour tour{2};
    Localizer localizer = localizer_at(particles::InitialPose{nonsense}, 2);
    EXPECT_EQ(localizer.counts().poses_refused, 1u);
    EXPECT_EQ(localizer.counts().searches, 1u);
    EXPECT_LT(scans_until_right(localizer, tour, 300), 300);
  }
}

TEST(GivenPose, WhereNobodyCanStandLeavesATrackedPoseAsItIs) {
  Tour tour{2};
  Localizer localizer = localizer_at(particles::InitialPose{tour.truth()}, 2);
  ASSERT_EQ(tour.next(localizer).estimate.state, LocalizerState::kTracking);
  EXPECT_FALSE(localizer.relocalize(particles::InitialPose{{-50.0, 3.0, 0.0}}));
  const TrackedScan tracked = tour.next(localizer);
  EXPECT_EQ(tracked.estimate.state, LocalizerState::kTracking);
  EXPECT_TRUE(right(tracked, tour));
  EXPECT_EQ(localizer.counts().searches, 0u);
}

TEST(RememberedPose, IsBelievedOnceTheFirstScansFit) {
  Tour tour{1};
  Localizer localizer = localizer_at(particles::InitialPose{.map_from_robot = tour.truth(), .remembered = true}, 1);
  const TrackedScan first = tour.next(localizer);
  EXPECT_NE(first.estimate.state, LocalizerState::kTracking);
  EXPECT_TRUE(right(first, tour));
  EXPECT_LE(scans_until_right(localizer, tour, 20), 5);
  EXPECT_EQ(localizer.counts().poses_confirmed, 1u);
  EXPECT_EQ(localizer.counts().searches, 0u);
}

TEST(RememberedPose, IsGivenUpWhereTheFirstScansDoNotFit) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Tour tour{seed};
    Localizer localizer =
        localizer_at(particles::InitialPose{.map_from_robot = {12.0, 12.5, 2.0}, .remembered = true}, seed);
    for (int i = 0; i < 300; ++i) {
      const TrackedScan tracked = tour.next(localizer);
      ASSERT_TRUE(tracked.estimate.state != LocalizerState::kTracking || right(tracked, tour)) << seed << ' ' << i;
    }
    EXPECT_EQ(localizer.counts().poses_refuted, 1u);
    EXPECT_EQ(tour.next(localizer).estimate.state, LocalizerState::kTracking);
  }
}

TEST(RememberedPose, IsNeitherConfirmedNorGivenUpByBlindScans) {
  Tour tour{1};
  Localizer localizer = localizer_at(particles::InitialPose{.map_from_robot = tour.truth(), .remembered = true}, 1);
  for (int i = 0; i < 20; ++i) {
    tour.step();
    localizer.observe(tour.odometry());
    const Estimate estimate = localizer.observe(blind(tour.scan())).estimate;
    ASSERT_EQ(estimate.state, LocalizerState::kGlobal) << i;
    ASSERT_LT(distance_between(estimate.map_from_robot, tour.truth()), 0.5) << i;
  }
  EXPECT_EQ(localizer.counts().poses_confirmed + localizer.counts().poses_refuted, 0u);
  EXPECT_LE(scans_until_right(localizer, tour, 20), 5);
  EXPECT_EQ(localizer.counts().poses_confirmed, 1u);
}

/// What beats the believed place may be an alias of one that nobody has looked at yet.
TEST(DoubtedPose, GoesOnAlongTheWheelsWhileTheSearchHasOnlyBegun) {
  constexpr double kBegunM = 0.9;
  Tour tour{1};
  Localizer localizer = localizer_after(20, tour, 1);
  tour.carry_to({14.0, 7.0, 2.5});
  TrackedScan last = tour.next(localizer);
  for (int i = 0; i < 300 && last.estimate.state != LocalizerState::kGlobal; ++i) last = tour.next(localizer);
  ASSERT_EQ(last.estimate.state, LocalizerState::kGlobal);
  EXPECT_EQ(localizer.counts().searches, 1u);
  const TrackedScan doubted = last;
  int compared = 0;
  for (last = tour.next(localizer); last.estimate.state == LocalizerState::kGlobal; last = tour.next(localizer)) {
    const Pose2 driven = motion_between(doubted.odom_from_robot, last.odom_from_robot);
    if (driven.position().norm() > kBegunM || std::abs(driven.theta) > radians(80.0)) break;
    const Pose2 carried_on = doubted.estimate.map_from_robot * driven;
    ASSERT_LT(distance_between(last.estimate.map_from_robot, carried_on), 1e-6) << compared;
    ++compared;
  }
  EXPECT_GT(compared, 3);
}

TEST(Silence, OfAMinuteMakesThePoseProveItself) {
  Tour tour{5};
  Localizer localizer = localizer_after(20, tour, 5);
  tour.wait(60.0);
  EXPECT_EQ(tour.next(localizer).estimate.state, LocalizerState::kGlobal);
  EXPECT_LT(scans_until_right(localizer, tour, 20), 10);
  EXPECT_EQ(localizer.counts().gaps, 1u);
  EXPECT_EQ(localizer.counts().poses_confirmed, 1u);
  EXPECT_EQ(localizer.counts().searches, 0u);
}

TEST(Silence, InWhichTheRobotWasCarriedOffMakesItSearchedForAtOnce) {
  Tour tour{6};
  Localizer localizer = localizer_after(20, tour, 6);
  tour.wait(60.0);
  tour.restart_controller();
  tour.carry_to({14.0, 7.0, 2.5});
  EXPECT_LT(scans_until_right(localizer, tour, 300), 75);
  EXPECT_EQ(localizer.counts().gaps, 1u);
  EXPECT_EQ(localizer.counts().odometry_epochs, 1u);
  EXPECT_EQ(localizer.counts().poses_refuted, 1u);
}

/// The wheels are 2 % off, and nobody knows that yet.
TEST(Silence, InWhichTheRobotDroveFarMakesItLookedForAllAboutAtTheFirstScan) {
  int right_at_once = 0;
  constexpr std::uint64_t kDrives = 8;
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    Tour tour{seed};
    Localizer localizer = localizer_after(20, tour, seed);
    tour.drive_unseen(localizer, 60.0);
    const TrackedScan first = tour.next(localizer);
    EXPECT_LT(first.estimate.belief.pose_right, 0.84) << "at the border of writing the map";
    right_at_once += right(first, tour) ? 1 : 0;
    EXPECT_LT(scans_until_right(localizer, tour, 100), 60) << seed;
    EXPECT_EQ(localizer.counts().gaps, 0u) << "the wheels have told of it";
  }
  EXPECT_GE(right_at_once, 7);
}

TEST(UnknownPose, IsNotFoundByBlindScansNorBrokenByThem) {
  Tour tour{3};
  Localizer localizer = localizer_at(std::nullopt, 3);
  for (int i = 0; i < 10; ++i) {
    tour.step();
    const TrackedScan tracked = localizer.observe(blind(tour.scan()));
    EXPECT_EQ(tracked.estimate.state, LocalizerState::kGlobal);
    EXPECT_TRUE(tracked.estimate.covariance.allFinite());
    EXPECT_TRUE(std::isfinite(tracked.estimate.map_from_robot.x));
  }
  EXPECT_EQ(localizer.counts().scans_without_return, 10u);
  EXPECT_EQ(localizer.counts().scans_without_odometry, 10u);
  EXPECT_LT(scans_until_right(localizer, tour, 300), 300);
}

}  // namespace
}  // namespace deltamap::localization::tour_test
