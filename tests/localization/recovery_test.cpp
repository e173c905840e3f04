// SPDX-License-Identifier: Apache-2.0
// A robot that is carried away, that wakes up elsewhere, or whose messages have gone bad.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "tests/support/scans/cast_scan.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::localization {
namespace {

constexpr double kScanPeriodS = 0.2;

Odometry at_rest() {
  Odometry odometry;
  odometry.time = timestamp_from_ns(1'700'000'000'000'000'000);
  return odometry;
}

/// A robot that drives round the drawn hall and can be lifted off its wheels.
class Tour {
 public:
  explicit Tour(std::uint64_t seed) : random_{seed} {}

  TrackedScan next(Localizer& localizer) {
    step();
    localizer.observe(odometry_);
    return localizer.observe(scan());
  }
  void step() {
    const std::vector<Point2> way{{18.5, 1.0}, {18.5, 7.0}, {1.5, 7.0}, {1.5, 1.0}};
    if ((way[goal_] - truth_.position()).norm() < 0.15) goal_ = (goal_ + 1) % way.size();
    const Point2 to = way[goal_] - truth_.position();
    const double off_rad = turn_between(truth_.theta, std::atan2(to.y(), to.x()));
    const Pose2 motion{std::abs(off_rad) > 0.5 ? 0.0 : 0.1, 0.0, std::clamp(off_rad, -0.15, 0.15)};
    truth_ = truth_ * motion;
    const Pose2 measured{motion.x * (1.02 + random_.normal(0.03)), 0.0, motion.theta * 1.02 + random_.normal(0.003)};
    odometry_.odom_from_robot = odometry_.odom_from_robot * measured;
    wait(kScanPeriodS);
  }
  /// Drives on while no scan comes.
  void drive_unseen(Localizer& localizer, double seconds) {
    for (double left_s = seconds; left_s > 0.0; left_s -= kScanPeriodS) {
      step();
      localizer.observe(odometry_);
    }
  }
  void wait(double seconds) { odometry_.time += duration_from_seconds(seconds); }
  void carry_to(const Pose2& place) {
    truth_ = place;
    goal_ = place.y > 4.0 ? 2 : 0;
  }
  void restart_controller() {
    odometry_.odom_from_robot = {};
    ++odometry_.epoch;
  }
  [[nodiscard]] const Odometry& odometry() const { return odometry_; }
  [[nodiscard]] Scan scan() { return test::cast_scan(world_, truth_, odometry_.time, {}, random_); }
  [[nodiscard]] const Pose2& truth() const { return truth_; }

 private:
  OccupancyGrid world_ = test::drawn_hall();
  Random random_;
  Pose2 truth_{2.0, 1.0, 0.0};
  std::size_t goal_ = 0;
  Odometry odometry_ = at_rest();
};

Localizer localizer_at(std::optional<particles::InitialPose> pose, std::uint64_t seed) {
  LocalizerParams params;
  params.particles.max = 2000;
  return Localizer{params, std::make_shared<const OccupancyGrid>(test::drawn_hall()), pose, seed};
}

bool right(const TrackedScan& tracked, const Tour& tour) {
  const Pose2& pose = tracked.estimate.map_from_robot;
  return distance_between(pose, tour.truth()) < 0.3 && std::abs(turn_between(pose.theta, tour.truth().theta)) < 0.1;
}

/// Scans until the pose is right and tracked; `most` where it never is.
int scans_until_right(Localizer& localizer, Tour& tour, int most) {
  for (int i = 0; i < most; ++i) {
    const TrackedScan tracked = tour.next(localizer);
    if (tracked.estimate.state == LocalizerState::kTracking && right(tracked, tour)) return i;
  }
  return most;
}

TEST(Recovery, FindsARobotThatWasCarriedAwayWithinThirtySeconds) {
  const int thirty_s = static_cast<int>(30.0 / kScanPeriodS);
  int late = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Tour tour{seed};
    Localizer localizer = localizer_at(particles::InitialPose{tour.truth()}, seed);
    for (int i = 0; i < 20; ++i) (void)tour.next(localizer);
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
    Localizer localizer = localizer_at(particles::InitialPose{tour.truth()}, seed);
    for (int i = 0; i < 30 + 3 * static_cast<int>(seed); ++i) (void)tour.next(localizer);
    const Pose2 before = tour.truth();
    tour.carry_to(before * Pose2{0.9, 0.4, 0.3});
    EXPECT_LT(scans_until_right(localizer, tour, 300), 150) << seed;
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

TEST(BadInput, ScansWithoutReturnsWhileThePoseIsUnknownFindNothingAndBreakNothing) {
  Tour tour{3};
  Localizer localizer = localizer_at(std::nullopt, 3);
  for (int i = 0; i < 10; ++i) {
    tour.step();
    Scan empty = tour.scan();
    for (Beam& beam : empty.beams) beam = Beam{};
    const TrackedScan tracked = localizer.observe(std::move(empty));
    EXPECT_EQ(tracked.estimate.state, LocalizerState::kGlobal);
    EXPECT_TRUE(tracked.estimate.covariance.allFinite());
    EXPECT_TRUE(std::isfinite(tracked.estimate.map_from_robot.x));
  }
  EXPECT_EQ(localizer.counts().scans_without_return, 10u);
  EXPECT_EQ(localizer.counts().scans_without_odometry, 10u);
  EXPECT_LT(scans_until_right(localizer, tour, 300), 300);
}

TEST(BadInput, AClockThatFallsBackIsCountedAndThePoseKept) {
  Tour tour{4};
  Localizer localizer = localizer_at(particles::InitialPose{tour.truth()}, 4);
  for (int i = 0; i < 20; ++i) (void)tour.next(localizer);
  tour.wait(-3600.0);
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(right(tour.next(localizer), tour)) << i;
  EXPECT_EQ(localizer.counts().clock_fell_back, 1u);
}

TEST(BadInput, AScanThatFallsBackBeforeOdometryDoesNeitherMovesNorLosesThePose) {
  for (const double back_s : {0.5, 1.0, 20.0, 3600.0}) {
    Tour tour{4};
    Localizer localizer = localizer_at(particles::InitialPose{tour.truth()}, 4);
    for (int i = 0; i < 120; ++i) (void)tour.next(localizer);
    tour.wait(-back_s);
    ASSERT_TRUE(right(localizer.observe(tour.scan()), tour)) << back_s;
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(right(tour.next(localizer), tour)) << back_s << " s, scan " << i;
  }
}

TEST(BadInput, BlindScansLeaveThePoseUndecided) {
  Tour tour{8};
  Localizer localizer = localizer_at(particles::InitialPose{tour.truth()}, 8);
  for (int i = 0; i < 200; ++i) (void)tour.next(localizer);
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
      Localizer localizer = localizer_at(particles::InitialPose{tour.truth()}, seed);
      for (int i = 0; i < 50; ++i) (void)tour.next(localizer);
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
  Localizer localizer = localizer_at(particles::InitialPose{tour.truth()}, 3);
  for (int i = 0; i < 50; ++i) (void)tour.next(localizer);
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

TEST(BadInput, AMinuteOfSilenceMakesThePoseProveItself) {
  Tour tour{5};
  Localizer localizer = localizer_at(particles::InitialPose{tour.truth()}, 5);
  for (int i = 0; i < 20; ++i) (void)tour.next(localizer);
  tour.wait(60.0);
  EXPECT_EQ(tour.next(localizer).estimate.state, LocalizerState::kGlobal);
  EXPECT_LT(scans_until_right(localizer, tour, 20), 10);
  EXPECT_EQ(localizer.counts().gaps, 1u);
  EXPECT_EQ(localizer.counts().poses_confirmed, 1u);
  EXPECT_EQ(localizer.counts().searches, 0u);
}

TEST(BadInput, ARobotCarriedOffInAMinuteOfSilenceIsSearchedForAtOnce) {
  Tour tour{6};
  Localizer localizer = localizer_at(particles::InitialPose{tour.truth()}, 6);
  for (int i = 0; i < 20; ++i) (void)tour.next(localizer);
  tour.wait(60.0);
  tour.restart_controller();
  tour.carry_to({14.0, 7.0, 2.5});
  EXPECT_LT(scans_until_right(localizer, tour, 300), 75);
  EXPECT_EQ(localizer.counts().gaps, 1u);
  EXPECT_EQ(localizer.counts().odometry_epochs, 1u);
  EXPECT_EQ(localizer.counts().poses_refuted, 1u);
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
}  // namespace deltamap::localization
