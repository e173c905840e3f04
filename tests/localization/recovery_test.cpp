// SPDX-License-Identifier: Apache-2.0
// A robot that is carried away, that is not seen for a while, or whose messages have gone bad.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/localization/hall_tour.hpp"

namespace deltamap::localization::tour_test {
namespace {

TEST(Recovery, FindsARobotThatWasCarriedAwayWithinThirtySeconds) {
  const int thirty_s = static_cast<int>(30.0 / kScanPeriodS);
  int late = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Tour tour{seed};
    Localizer localizer = localizer_after(20, tour, seed);
    Random random{seed + 100};
    const Point2 low = seed % 2 == 0 ? Point2{11.0, 0.6} : Point2{4.0, 6.2};
    tour.carry_to({low.x() + 7.0 * random.uniform(), low.y() + random.uniform(), random.uniform(-3.0, 3.0)});
    late += scans_until_right(localizer, tour, 2 * thirty_s) > thirty_s ? 1 : 0;
    ASSERT_GT(localizer.counts().recoveries + localizer.counts().searches, 0u) << seed;
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(right(tour.next(localizer), tour)) << seed << ' ' << i;
  }
  EXPECT_LE(late, 1);
}

TEST(Recovery, FindsARobotThatSlippedAMetre) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Tour tour{seed};
    Localizer localizer = localizer_after(30 + 3 * static_cast<int>(seed), tour, seed);
    const Pose2 before = tour.truth();
    tour.carry_to(before * Pose2{0.9, 0.4, 0.3});
    EXPECT_LT(scans_until_right(localizer, tour, 300), 150) << seed;
  }
}

TEST(Recovery, TellsWithinASecondThatTheRobotWasCarriedAndCallsThePoseRightNoMore) {
  Tour tour{1};
  Localizer localizer = localizer_after(150, tour, 1);
  ASSERT_FALSE(tour.next(localizer).estimate.belief.broke_off_at);
  tour.carry_to({14.0, 7.0, 2.5});
  const Timestamp carried_after = tour.odometry().time;
  TrackedScan tracked = tour.next(localizer);
  EXPECT_GT(tracked.estimate.belief.broke_off_at, carried_after);
  for (int i = 0; i < 4; ++i) tracked = tour.next(localizer);
  EXPECT_TRUE(tracked.estimate.belief.fits_worse);
  EXPECT_NE(tracked.estimate.belief.verdict, PoseVerdict::kRight);
  EXPECT_LE(tracked.estimate.belief.pose_right, 0.5);
}

TEST(Recovery, TellsOfNoCarriedRobotWhereScansComeWithoutOdometry) {
  Tour tour{1};
  Localizer localizer = localizer_after(150, tour, 1);
  for (int i = 0; i < 20; ++i) {
    tour.wait(kScanPeriodS);
    EXPECT_FALSE(localizer.observe(tour.scan()).estimate.belief.broke_off_at) << i;
  }
}

TEST(Recovery, NeverJumpsWhileAllIsWell) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Tour tour{seed};
    Localizer localizer = localizer_at(particles::InitialPose{tour.truth()}, seed);
    for (int i = 0; i < 500; ++i) ASSERT_TRUE(right(tour.next(localizer), tour)) << seed << ' ' << i;
    EXPECT_EQ(localizer.counts().recoveries, 0u);
    EXPECT_EQ(localizer.counts().searches, 0u);
    EXPECT_EQ(localizer.counts().scans, 500u);
  }
}

TEST(BadInput, AClockThatFallsBackIsCountedAndThePoseKept) {
  Tour tour{4};
  Localizer localizer = localizer_after(20, tour, 4);
  tour.wait(-3600.0);
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(right(tour.next(localizer), tour)) << i;
  EXPECT_EQ(localizer.counts().clock_fell_back, 1u);
}

TEST(BadInput, AScanThatFallsBackBeforeOdometryDoesNeitherMovesNorLosesThePose) {
  for (const double back_s : {0.5, 1.0, 20.0, 3600.0}) {
    Tour tour{4};
    Localizer localizer = localizer_after(120, tour, 4);
    tour.wait(-back_s);
    ASSERT_TRUE(right(localizer.observe(tour.scan()), tour)) << back_s;
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(right(tour.next(localizer), tour)) << back_s << " s, scan " << i;
  }
}

TEST(BadInput, BlindScansLeaveThePoseUndecided) {
  Tour tour{8};
  Localizer localizer = localizer_after(200, tour, 8);
  PoseVerdict verdict = PoseVerdict::kRight;
  for (int i = 0; i < 300; ++i) {
    tour.step();
    Scan empty = tour.scan();
    for (Beam& beam : empty.beams) beam = Beam{};
    verdict = localizer.observe(std::move(empty)).estimate.belief.verdict;
  }
  EXPECT_EQ(verdict, PoseVerdict::kUndecided);
}

/// Up to 25 m of driving and turning; the hall looks alike in places.
TEST(ScanGap, IsBridgedByTheWheelsAndThePoseStaysTracked) {
  int strayed = 0;
  int strayed_within_a_minute = 0;
  for (const double gap_s : {1.0, 4.0, 10.0, 25.0, 40.0, 60.0}) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      Tour tour{seed};
      Localizer localizer = localizer_after(50, tour, seed);
      tour.drive_unseen(localizer, gap_s);
      const TrackedScan first = tour.next(localizer);
      ASSERT_EQ(first.estimate.state, LocalizerState::kTracking) << gap_s << " s, seed " << seed;
      int wrong = 0;
      for (int i = 0; i < 50; ++i) wrong += right(tour.next(localizer), tour) ? 0 : 1;
      strayed += wrong > 15 ? 1 : 0;
      strayed_within_a_minute += wrong > 15 && gap_s < 60.0 ? 1 : 0;
      EXPECT_EQ(localizer.counts().gaps, 0u);
      EXPECT_EQ(localizer.counts().poses_refuted, 0u);
    }
  }
  EXPECT_LE(strayed_within_a_minute, 3) << "of 60; 1 in 100 is usual";
  EXPECT_LE(strayed, 6) << "of 72; 1 in 30 is usual";
}

TEST(ScanGap, TheFirstScanFindsTheRobotWhereTheWheelsHaveBroughtIt) {
  for (const bool surfaces : {true, false}) {
    Tour tour{2};
    LocalizerParams params;
    params.follow_surfaces = surfaces;
    Localizer localizer{params, std::make_shared<const OccupancyGrid>(test::drawn_hall()),
                        particles::InitialPose{tour.truth()}, 2};
    for (int i = 0; i < 50; ++i) (void)tour.next(localizer);
    tour.drive_unseen(localizer, 12.0);
    for (int i = 0; i < 4; ++i) {  // it stands: the scan itself shows no motion
      tour.wait(kScanPeriodS);
      localizer.observe(tour.odometry());
    }
    EXPECT_TRUE(right(localizer.observe(tour.scan()), tour)) << "surfaces: " << surfaces;
  }
}

/// A view that fits little is no proof against a pose that the wheels have kept.
TEST(ScanGap, ThePoseIsKeptWhereTheWorldHasChangedMeanwhile) {
  Tour tour{3};
  Localizer localizer = localizer_after(50, tour, 3);
  tour.drive_unseen(localizer, 4.0);
  for (double left_s = 26.0; left_s > 0.0; left_s -= kScanPeriodS) {
    tour.wait(kScanPeriodS);
    localizer.observe(tour.odometry());
  }
  for (int i = 0; i < 6; ++i) {
    tour.step();
    localizer.observe(tour.odometry());
    Scan scan = tour.scan();  // somebody stands before half of it
    for (std::size_t k = 0; k < scan.beams.size() / 2; ++k) scan.beams[k] = {0.8F, 0.0F, BeamKind::kRange};
    ASSERT_TRUE(right(localizer.observe(std::move(scan)), tour)) << i;
  }
  EXPECT_EQ(localizer.counts().searches, 0u);
  EXPECT_EQ(tour.next(localizer).estimate.state, LocalizerState::kTracking);
}

TEST(ScanGap, WidensThePoseByWhatWasDrivenNotByWhatLiesBetweenItsEnds) {
  LocalizerParams params;
  params.motion.slip_probability = 0.0;
  Localizer localizer{params, std::make_shared<const OccupancyGrid>(test::drawn_hall()),
                      particles::InitialPose{{2.0, 1.0, 0.0}}, 1};
  Odometry odometry = at_rest();
  Scan blind;
  const auto deviation_after = [&](double turn_rad) {
    for (int i = 0; i < 300; ++i) {
      odometry.time += duration_from_seconds(0.1);
      odometry.odom_from_robot = odometry.odom_from_robot * Pose2{turn_rad > 0.0 ? 0.04 : 0.0, 0.0, turn_rad};
      localizer.observe(odometry);
    }
    blind.time = odometry.time;
    const PoseCovariance& c = localizer.observe(blind).estimate.covariance;
    return std::sqrt(c(0, 0) + c(1, 1));
  };
  blind.time = odometry.time;
  localizer.observe(odometry);
  (void)localizer.observe(blind);
  const double standing_m = deviation_after(0.0);
  const double driving_m = deviation_after(4.0 * std::numbers::pi / 300.0);  // twice round a circle: back where it was
  EXPECT_GT(driving_m, standing_m + 0.1);
}

TEST(BadInput, NothingIsBelievedOnAMapOnWhichNothingFits) {
  OccupancyGrid other{{200, 200, 0.1, {0.0, 0.0}}, CellState::kFree};
  test::fill_box(other, {3.0, 3.0}, {3.2, 3.2}, CellState::kOccupied);
  Tour tour{7};
  Localizer localizer{LocalizerParams{}, std::make_shared<const OccupancyGrid>(other), std::nullopt, 7};
  for (int i = 0; i < 600; ++i) {
    ASSERT_NE(tour.next(localizer).estimate.state, LocalizerState::kTracking) << i;
  }
}

}  // namespace
}  // namespace deltamap::localization::tour_test
