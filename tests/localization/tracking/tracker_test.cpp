// SPDX-License-Identifier: Apache-2.0
#include "localization/tracking/tracker.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "localization/motion/deskew.hpp"
#include "tests/support/worlds/drawn_flat.hpp"

namespace deltamap::localization::tracking {
namespace {

const Pose2 kStart{4.0, 1.6, 0.1};
const particles::InitialPose kSure{kStart, 0.05, radians(2.0)};

/// A robot in the flat whose wheels are right, followed by a tracker.
class FlatDrive {
 public:
  explicit FlatDrive(const TrackerParams& params) : tracker_{params, map_, 1} { (void)tracker_.start_around(kSure); }

  Tracker::Answer next(const Pose2& motion, double passed_s = 0.1) { return next(motion, passed_s, true); }
  Tracker::Answer next_blind(const Pose2& motion, double passed_s = 0.1) { return next(motion, passed_s, false); }
  /// No scan comes.
  void drive_unseen(const Pose2& motion) {
    step(motion, 0.1);
    tracker_.predict(now());
  }
  /// Where a look around shall find the scan; of what prior it was asked.
  void let_find(std::function<Pose2(const Pose2& truth)> find) { find_ = std::move(find); }
  [[nodiscard]] const std::optional<sensor::RefinedPose>& asked() const { return asked_; }
  [[nodiscard]] const Pose2& truth() const { return truth_; }
  void slip(const Pose2& by) { truth_ = truth_ * by; }
  void set_clock_back(double by_s) { time_ -= duration_from_seconds(by_s); }

  [[nodiscard]] Tracker& tracker() { return tracker_; }
  [[nodiscard]] Timestamp time() const { return time_; }
  [[nodiscard]] double error_m(const Tracker::Answer& answer) const {
    return distance_between(answer.believed.map_from_robot, truth_);
  }

 private:
  void step(const Pose2& motion, double passed_s) {
    truth_ = truth_ * motion;
    odom_ = odom_ * motion;
    time_ += duration_from_seconds(passed_s);
  }
  Tracker::Answer next(const Pose2& motion, double passed_s, bool sees) {
    step(motion, passed_s);
    const Scan scan = test::cast_scan(*map_, truth_, time_, {}, random_);
    const std::vector<RayInRobot> rays = motion::deskewed(scan, {});
    motion::BeamEnds ends;
    if (sees) ends = motion::scoring_ends(scan, rays, 0);
    surfaces::FaceFinder faces;
    if (sees) faces.begin(scan, rays);
    const auto poses_within = [this](const sensor::RefinedPose& prior) {
      asked_ = prior;
      return std::vector<sensor::ProposedPose>{{find_(truth_), 0.0}};
    };
    tracking::SeenScan seen{.now = now(), .ends = ends, .field = field_, .faces = faces};
    if (find_) seen.poses_within = poses_within;
    return tracker_.observe(seen);
  }
  [[nodiscard]] motion::ScanInstant now() const { return {time_, motion::OdometryAt{odom_, 0, odom_}}; }

  std::shared_ptr<const OccupancyGrid> map_ = std::make_shared<const OccupancyGrid>(test::drawn_flat());
  sensor::LikelihoodField field_{*map_, {}};
  Tracker tracker_;
  std::function<Pose2(const Pose2& truth)> find_;
  std::optional<sensor::RefinedPose> asked_;
  Pose2 truth_ = kStart;
  Pose2 odom_;
  Timestamp time_ = timestamp_from_ns(1'700'000'000'000'000'000);
  Random random_{5};
};

TrackerParams particles_alone() {
  TrackerParams params;
  params.follow_surfaces = false;
  return params;
}

std::vector<double> headings(const Tracker& tracker) { return tracker.particles()->heading_rad; }

TEST(Tracker, BelievesTheStartBeforeAScanIsRead) {
  FlatDrive drive{particles_alone()};
  const sensor::RefinedPose believed = drive.tracker().start_around({{7.0, 1.0, 0.5}, 0.1, 0.05});
  EXPECT_NEAR(believed.map_from_robot.x, 7.0, 0.02);
  EXPECT_NEAR(believed.covariance(0, 0), 0.1 * 0.1, 0.003);
  EXPECT_NEAR(drive.tracker().best().weight, 1.0, 0.02);
}

TEST(Tracker, TakesTheMostParticlesWhereTheRobotMayBeFarOff) {
  FlatDrive drive{particles_alone()};
  EXPECT_EQ(drive.tracker().particle_count(), 500u);
  (void)drive.tracker().start_around({kStart, 1.0, 0.5});
  EXPECT_EQ(drive.tracker().particle_count(), 5000u);
}

TEST(Tracker, FollowsTheRobotByItsScans) {
  FlatDrive drive{particles_alone()};
  Tracker::Answer answer;
  for (int i = 0; i < 40; ++i) answer = drive.next({0.05, 0.0, 0.01});
  EXPECT_LT(drive.error_m(answer), 0.03);
  EXPECT_GT(answer.w_avg.value_or(0.0), 0.5);
}

TEST(Tracker, LetsAScanWeighTheParticlesOnlyWhereTheRobotHasMovedOrTimeHasPassed) {
  FlatDrive drive{particles_alone()};
  EXPECT_TRUE(drive.next({}).n_eff) << "the first scan after a start";
  const std::vector<double> before = headings(drive.tracker());
  for (int i = 0; i < 9; ++i) {
    const Tracker::Answer answer = drive.next({0.001, 0.0, 0.0});
    ASSERT_FALSE(answer.n_eff) << i;
    ASSERT_TRUE(answer.w_avg) << i;
  }
  EXPECT_EQ(headings(drive.tracker()), before);
  EXPECT_TRUE(drive.next({0.001, 0.0, 0.0}).n_eff) << "a second has passed";
  EXPECT_TRUE(drive.next({0.051, 0.0, 0.0}).n_eff);
  EXPECT_TRUE(drive.next({0.0, 0.0, radians(2.1)}).n_eff);
  EXPECT_FALSE(drive.next({0.049, 0.0, 0.0}).n_eff);
}

TEST(Tracker, FollowsTheWheelsBetweenUpdates) {
  FlatDrive drive{particles_alone()};
  const Pose2 before = drive.next({}).believed.map_from_robot;
  const Pose2 after = drive.next_blind({0.04, 0.0, 0.0}).believed.map_from_robot;
  EXPECT_LT(distance_between(after, before * Pose2{0.04, 0.0, 0.0}), 1e-9);
}

TEST(Tracker, HasNoMeanLikelihoodWithoutAReturn) {
  FlatDrive drive{particles_alone()};
  (void)drive.next({});
  const Tracker::Answer between = drive.next_blind({});
  EXPECT_FALSE(between.w_avg);
  const Tracker::Answer update = drive.next_blind({0.1, 0.0, 0.0});
  EXPECT_FALSE(update.w_avg);
  EXPECT_TRUE(update.n_eff) << "the particles have moved";
}

TEST(Tracker, GoesAlongWithTheWheelsWhileNoScanComesAndIsLessSure) {
  FlatDrive drive{particles_alone()};
  (void)drive.next({});
  const double before_m2 = drive.next_blind({}).believed.covariance(0, 0);
  for (int i = 0; i < 30; ++i) drive.drive_unseen({0.05, 0.0, 0.0});
  const Tracker::Answer blind = drive.next_blind({});
  EXPECT_TRUE(blind.n_eff) << "the first scan is an update";
  EXPECT_LT(drive.error_m(blind), 0.3);
  EXPECT_GT(blind.believed.covariance(0, 0), 4.0 * before_m2);
  EXPECT_LT(drive.error_m(drive.next({})), 0.05);
}

/// Round and round without a scan, until the wheels leave the pose open by metres.
void drive_far_unseen(FlatDrive& drive) {
  for (int i = 0; i < 1200; ++i) drive.drive_unseen({0.05, 0.0, 0.1});
}

TEST(Tracker, LooksAllAboutForTheFirstScanAfterALongDriveWithoutAny) {
  FlatDrive drive{particles_alone()};
  for (int i = 0; i < 10; ++i) (void)drive.next({0.05, 0.0, 0.01});
  drive.let_find([](const Pose2& truth) { return truth; });
  drive_far_unseen(drive);
  drive.slip({1.5, 0.4, 0.5});
  const Tracker::Answer answer = drive.next({});
  EXPECT_TRUE(answer.looked_around);
  ASSERT_TRUE(drive.asked());
  EXPECT_GT(drive.asked()->covariance(0, 0), 0.15 * 0.15);
  EXPECT_LT(drive.error_m(answer), 0.05);
  EXPECT_FALSE(drive.next({}).looked_around) << "once";
}

TEST(Tracker, DoesNotLookAroundAfterScansThatShowedNothing) {
  for (const bool surfaces : {false, true}) {
    TrackerParams params;
    params.follow_surfaces = surfaces;
    FlatDrive drive{params};
    for (int i = 0; i < 10; ++i) (void)drive.next({0.05, 0.0, 0.01});
    drive.let_find([](const Pose2& truth) { return truth; });
    drive_far_unseen(drive);
    EXPECT_FALSE(drive.next_blind({}).looked_around);
    EXPECT_FALSE(drive.next({}).looked_around);
    EXPECT_FALSE(drive.asked());
  }
}

TEST(Tracker, LooksWhereItWasDrivenWhileScansShowedNothingToo) {
  FlatDrive drive{{}};
  for (int i = 0; i < 10; ++i) (void)drive.next({0.05, 0.0, 0.01});
  drive.let_find([](const Pose2& truth) { return truth; });
  for (int i = 0; i < 1200; ++i) (void)drive.next_blind({0.05, 0.0, 0.1});
  for (int i = 0; i < 3; ++i) drive.drive_unseen({0.05, 0.0, 0.1});
  drive.slip({0.6, 0.4, 0.15});
  const Tracker::Answer answer = drive.next({});
  EXPECT_TRUE(answer.looked_around);
  EXPECT_LT(drive.error_m(answer), 0.05);
}

TEST(Tracker, DoesNotLookAroundAfterAShortDriveWithoutScans) {
  FlatDrive drive{particles_alone()};
  for (int i = 0; i < 10; ++i) (void)drive.next({0.05, 0.0, 0.01});
  drive.let_find([](const Pose2& truth) { return truth; });
  for (int i = 0; i < 5; ++i) drive.drive_unseen({0.05, 0.0, 0.0});
  EXPECT_FALSE(drive.next({}).looked_around);
  EXPECT_FALSE(drive.asked());
}

TEST(Tracker, AsksWhereTheCalibratedWheelsLeadWhereSurfacesHaveLed) {
  FlatDrive drive{{}};
  for (int i = 0; i < 60; ++i) (void)drive.next({0.05, 0.0, i < 30 ? 0.02 : -0.02});
  ASSERT_EQ(drive.tracker().particles(), nullptr);
  drive.let_find([](const Pose2& truth) { return truth; });
  drive_far_unseen(drive);
  const Pose2 by_wheels = drive.truth();
  drive.slip({0.6, 0.2, 0.1});
  const Tracker::Answer answer = drive.next({});
  EXPECT_TRUE(answer.looked_around);
  ASSERT_TRUE(drive.asked());
  EXPECT_LT(distance_between(drive.asked()->map_from_robot, by_wheels), 0.5);
  EXPECT_LT(drive.error_m(answer), 0.05);
}

TEST(Tracker, WeighsAgainASecondAfterTheClockHasFallenBack) {
  FlatDrive drive{particles_alone()};
  (void)drive.next({});
  drive.set_clock_back(3600.0);
  drive.tracker().restart_clock(drive.time());
  EXPECT_FALSE(drive.next({}, 0.9).n_eff);
  EXPECT_TRUE(drive.next({}, 0.2).n_eff);
}

TEST(Tracker, SaysHowLongNoWheelsSpokeForTheRobot) {
  FlatDrive drive{particles_alone()};
  (void)drive.next({});
  EXPECT_EQ(drive.next({}).unknown_s, 0.0);
  Tracker& tracker = drive.tracker();
  const motion::ScanInstant without_wheels{drive.time() + duration_from_seconds(0.5), std::nullopt};
  const OccupancyGrid map = test::drawn_flat();
  const sensor::LikelihoodField field{map, {}};
  surfaces::FaceFinder faces;
  EXPECT_NEAR(tracker.observe({.now = without_wheels, .ends = {}, .field = field, .faces = faces}).unknown_s, 0.6,
              1e-6);
}

TEST(Tracker, LetsSurfacesLeadWhereTheyExplainTheScansAndTheParticlesRest) {
  FlatDrive drive{{}};
  EXPECT_NE(drive.tracker().particles(), nullptr);
  Tracker::Answer answer;
  for (int i = 0; i < 60; ++i) answer = drive.next({0.05, 0.0, i < 30 ? 0.02 : -0.02});
  EXPECT_EQ(drive.tracker().particles(), nullptr);
  EXPECT_TRUE(drive.tracker().is_fixed_by_surfaces());
  EXPECT_LT(drive.error_m(answer), 0.03);
  (void)drive.tracker().start_around(kSure);
  EXPECT_NE(drive.tracker().particles(), nullptr) << "the pose was set: the particles lead";
  EXPECT_FALSE(drive.tracker().is_fixed_by_surfaces());
}

TEST(Tracker, KnowsNothingOfTheWheelsWhereSurfacesAreNotFollowed) {
  FlatDrive drive{particles_alone()};
  const Tracker::Answer answer = drive.next({});
  EXPECT_FALSE(drive.tracker().calibration());
  EXPECT_EQ(drive.tracker().not_counted_in(answer.believed).bias, PoseCovariance::Zero());
  EXPECT_TRUE(FlatDrive{{}}.tracker().calibration());
}

}  // namespace
}  // namespace deltamap::localization::tracking
