// SPDX-License-Identifier: Apache-2.0
#include "localization/localizer.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "localization/localizer_params.hpp"
#include "tests/support/scans/cast_scan.hpp"
#include "tests/support/worlds/drawn_flat.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::localization {
namespace {

constexpr double kScanPeriodS = 0.2;

/// A robot that drives to and fro along a lane of constant y, with odometry that drifts.
class Drive {
 public:
  explicit Drive(OccupancyGrid world) : world_{std::move(world)} {}

  TrackedScan next(Localizer& localizer) {
    step();
    Odometry odometry;
    odometry.time = time_;
    odometry.odom_from_robot = odom_;
    odometry.epoch = epoch_;
    localizer.observe(odometry);
    return localizer.observe(test::cast_scan(world_, truth_, time_, {}, random_));
  }

  void step() {
    time_ += duration_from_seconds(kScanPeriodS);
    const bool at_end = (truth_.x > lane_end_m_ && !backwards_) || (truth_.x < lane_start_m_ && backwards_);
    if (at_end && turns_left_ == 0) turns_left_ = 10;
    const Pose2 motion = standing_         ? Pose2{}
                         : turns_left_ > 0 ? Pose2{0.0, 0.0, std::numbers::pi / 10.0}
                                           : Pose2{0.08, 0.0, 0.0};
    truth_ = truth_ * motion;
    if (!standing_ && turns_left_ > 0 && --turns_left_ == 0) backwards_ = !backwards_;
    odom_ = odom_ * Pose2{motion.x * 1.03, 0.0, motion.theta * 0.97 + motion.x * 0.03};
  }

  void stand() { standing_ = true; }
  void jump_odometry() {
    odom_ = {100.0, 100.0, 1.0};
    ++epoch_;
  }
  void fall_back(double by_s) { time_ -= duration_from_seconds(by_s); }
  OccupancyGrid& world() { return world_; }
  /// Someone lifts the robot into another lane; its wheels do not notice.
  void carry_to(const Point2& position, double lane_start_m, double lane_end_m) {
    truth_ = {position.x(), position.y(), backwards_ ? std::numbers::pi : 0.0};
    turns_left_ = 0;
    lane_start_m_ = lane_start_m;
    lane_end_m_ = lane_end_m;
  }
  [[nodiscard]] const Pose2& truth() const { return truth_; }
  [[nodiscard]] Timestamp time() const { return time_; }

 private:
  OccupancyGrid world_;
  Pose2 truth_{4.0, 1.6, 0.0};
  Pose2 odom_;
  Timestamp time_ = timestamp_from_ns(1'700'000'000'000'000'000);
  std::uint32_t epoch_ = 0;
  bool standing_ = false;
  bool backwards_ = false;
  int turns_left_ = 0;
  double lane_start_m_ = 3.8;
  double lane_end_m_ = 7.3;
  Random random_{21};
};

LocalizerParams small() {
  LocalizerParams params;
  params.particles.min = 300;
  params.particles.max = 3000;
  return params;
}

Localizer localizer_at_start(const LocalizerParams& params, const OccupancyGrid& map, std::uint64_t seed = 1) {
  return Localizer{params, std::make_shared<const OccupancyGrid>(map), particles::InitialPose{{4.1, 1.5, 0.05}}, seed};
}

TEST(Localizer, FollowsADrivingRobotThroughDrift) {
  Drive drive{test::drawn_flat()};
  Localizer localizer = localizer_at_start(small(), test::drawn_flat());
  for (int i = 0; i < 300; ++i) {
    const TrackedScan tracked = drive.next(localizer);
    if (i < 10) continue;
    ASSERT_LT(distance_between(tracked.estimate.map_from_robot, drive.truth()), 0.15) << i;
    ASSERT_LT(std::abs(turn_between(tracked.estimate.map_from_robot.theta, drive.truth().theta)), 0.06) << i;
    ASSERT_EQ(tracked.estimate.state, LocalizerState::kTracking);
  }
}

TEST(Localizer, FillsInEverythingThatTheOthersJudgeBy) {
  Drive drive{test::drawn_flat()};
  Localizer localizer = localizer_at_start(small(), test::drawn_flat());
  for (int i = 0; i < 5; ++i) (void)drive.next(localizer);
  const TrackedScan tracked = drive.next(localizer);
  EXPECT_EQ(tracked.rays.size(), tracked.scan.beams.size());
  EXPECT_EQ(tracked.estimate.time, tracked.scan.time);
  EXPECT_NEAR(tracked.speed_m_per_s, 0.08 * 1.03 / kScanPeriodS, 0.02);
  EXPECT_GE(tracked.estimate.n_eff, 1.0);
  EXPECT_LE(tracked.estimate.n_eff, tracked.estimate.particles);
  EXPECT_GT(tracked.estimate.w_avg, 0.3);
  EXPECT_LE(tracked.estimate.w_avg, 1.0);
  EXPECT_EQ(tracked.estimate.revision, 0u);
  ASSERT_TRUE(tracked.estimate.map);
  EXPECT_GT(tracked.estimate.covariance.determinant(), 0.0);
}

TEST(Localizer, FindsItsPlaceAboutAStartThatMayBeFarOff) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Drive drive{test::drawn_flat()};
    const particles::InitialPose given{drive.truth() * Pose2{0.5, -0.4, 0.15}, 0.4, radians(10.0)};
    Localizer localizer{small(), std::make_shared<const OccupancyGrid>(test::drawn_flat()), given, seed};
    Pose2 believed;
    for (int i = 0; i < 5; ++i) believed = drive.next(localizer).estimate.map_from_robot;
    EXPECT_LT(distance_between(believed, drive.truth()), 0.15) << seed;
  }
}

TEST(Localizer, GivesTheSameBytesForTheSameInputAndSeed) {
  const auto run = [](std::uint64_t seed) {
    Drive drive{test::drawn_flat()};
    Localizer localizer = localizer_at_start(small(), test::drawn_flat(), seed);
    std::vector<double> numbers;
    for (int i = 0; i < 60; ++i) {
      const Estimate estimate = drive.next(localizer).estimate;
      for (const double number : {estimate.map_from_robot.x, estimate.map_from_robot.y, estimate.map_from_robot.theta,
                                  estimate.n_eff, estimate.w_avg, estimate.covariance(0, 1)}) {
        numbers.push_back(number);
      }
    }
    return numbers;
  };
  EXPECT_EQ(run(5), run(5));
  EXPECT_NE(run(5), run(6));
}

TEST(Localizer, AnswersEveryScanOfAStandingRobotAndStaysHonest) {
  Drive drive{test::drawn_flat()};
  Localizer localizer = localizer_at_start(small(), test::drawn_flat());
  drive.stand();
  for (int i = 0; i < 600; ++i) {
    const Estimate estimate = drive.next(localizer).estimate;
    ASSERT_EQ(estimate.time, drive.time());
    if (i < 20) continue;
    ASSERT_GT(estimate.w_avg, 0.5);
    ASSERT_LT(distance_between(estimate.map_from_robot, drive.truth()), 0.1);
    ASSERT_GT(std::sqrt(estimate.covariance(0, 0)), 0.002);
  }
}

TEST(Localizer, SaysOfWhichScansItHasCountedTheBeams) {
  Drive drive{test::drawn_flat()};
  LocalizerParams params = small();
  params.judgement.check_s = 0.75;  // three scans and a bit: every fourth is held against the map
  Localizer localizer = localizer_at_start(params, test::drawn_flat());
  drive.stand();
  std::vector<bool> checked;
  for (int i = 0; i < 13; ++i) {
    const Belief belief = drive.next(localizer).estimate.belief;
    checked.push_back(belief.is_checked);
    EXPECT_GT(belief.stable.expected + belief.elsewhere.expected, 0u) << i;
  }
  for (std::size_t i = 0; i < checked.size(); ++i) EXPECT_EQ(checked[i], i % 4 == 0) << i;
}

TEST(Localizer, FindsItselfWithoutAnInitialPose) {
  Drive drive{test::drawn_flat()};
  Localizer localizer{small(), std::make_shared<const OccupancyGrid>(test::drawn_flat()), std::nullopt, 3};
  TrackedScan tracked = drive.next(localizer);
  EXPECT_EQ(tracked.estimate.state, LocalizerState::kGlobal);
  for (int i = 0; i < 150; ++i) tracked = drive.next(localizer);
  EXPECT_EQ(tracked.estimate.state, LocalizerState::kTracking);
  EXPECT_LT(distance_between(tracked.estimate.map_from_robot, drive.truth()), 0.15);
}

TEST(Localizer, FindsItselfAfterBeingCarriedAway) {
  Drive drive{test::drawn_flat()};
  Localizer localizer = localizer_at_start(small(), test::drawn_flat());
  for (int i = 0; i < 20; ++i) (void)drive.next(localizer);
  drive.carry_to({6.8, 5.3}, 6.8, 9.3);
  TrackedScan tracked;
  for (int i = 0; i < 900; ++i) {
    tracked = drive.next(localizer);
    const bool there = distance_between(tracked.estimate.map_from_robot, drive.truth()) < 1.0;
    EXPECT_TRUE(there || tracked.estimate.belief.verdict != PoseVerdict::kRight) << i;
  }
  EXPECT_GT(localizer.counts().recoveries + localizer.counts().searches, 0u);
  EXPECT_EQ(tracked.estimate.state, LocalizerState::kTracking);
  EXPECT_LT(distance_between(tracked.estimate.map_from_robot, drive.truth()), 0.2);
}

TEST(Localizer, StartsAgainAroundThePoseThatAPersonGives) {
  Drive drive{test::drawn_flat()};
  Localizer localizer = localizer_at_start(small(), test::drawn_flat());
  for (int i = 0; i < 10; ++i) EXPECT_EQ(drive.next(localizer).estimate.relocalizations, 0U);
  localizer.relocalize({{1.0, 1.0, 2.0}});
  const Estimate wrong = drive.next(localizer).estimate;
  EXPECT_EQ(wrong.relocalizations, 1U);
  EXPECT_LT(std::hypot(wrong.map_from_robot.x - 1.0, wrong.map_from_robot.y - 1.0), 0.8);
  localizer.relocalize({drive.truth()});
  TrackedScan tracked;
  for (int i = 0; i < 10; ++i) tracked = drive.next(localizer);
  EXPECT_LT(distance_between(tracked.estimate.map_from_robot, drive.truth()), 0.1);
}

TEST(Localizer, RefusesAMapWithoutFreeCells) {
  const auto full = std::make_shared<const OccupancyGrid>(test::drawn_grid({"###", "# #"}));
  EXPECT_THROW((Localizer{LocalizerParams{}, full, std::nullopt, 1}), std::runtime_error);
  EXPECT_THROW((Localizer{LocalizerParams{}, std::make_shared<const OccupancyGrid>(), particles::InitialPose{}, 1}),
               std::runtime_error);
}

TEST(Localizer, CarriesThePoseByOdometryThroughScansWithoutReturns) {
  Drive drive{test::drawn_flat()};
  Localizer localizer = localizer_at_start(small(), test::drawn_flat());
  TrackedScan tracked;
  for (int i = 0; i < 15; ++i) tracked = drive.next(localizer);
  const double w_avg = tracked.estimate.w_avg;
  drive.world() = OccupancyGrid{test::drawn_flat().geometry(), CellState::kFree};
  for (int i = 0; i < 10; ++i) {
    tracked = drive.next(localizer);
    EXPECT_EQ(tracked.estimate.w_avg, w_avg);
  }
  EXPECT_LT(distance_between(tracked.estimate.map_from_robot, drive.truth()), 0.2);
  EXPECT_EQ(tracked.estimate.state, LocalizerState::kTracking);
}

TEST(Localizer, TellsWithEachScanHowFarItsRangesErr) {
  LocalizerParams params = small();
  params.range_deviation_m = 0.05;
  Localizer localizer = localizer_at_start(params, test::drawn_flat());
  EXPECT_EQ(localizer.observe(Scan{}).scan.range_deviation_m, 0.05);
}

TEST(Localizer, AnswersAScanWithoutAnyBeam) {
  Localizer localizer = localizer_at_start(small(), test::drawn_flat());
  Scan empty;
  empty.time = timestamp_from_ns(1'700'000'000'000'000'000);
  const TrackedScan tracked = localizer.observe(empty);
  EXPECT_TRUE(tracked.rays.empty());
  EXPECT_NEAR(tracked.estimate.map_from_robot.x, 4.1, 0.1);
  EXPECT_EQ(tracked.estimate.w_avg, 1.0);
}

TEST(Localizer, WorksWithoutOdometry) {
  Drive drive{test::drawn_flat()};
  Localizer localizer = localizer_at_start(small(), test::drawn_flat());
  Random random{2};
  Timestamp time = drive.time();
  Pose2 truth = drive.truth();
  Estimate estimate;
  for (int i = 0; i < 40; ++i) {
    time += duration_from_seconds(kScanPeriodS);
    truth = truth * Pose2{0.02, 0.0, 0.0};
    estimate = localizer.observe(test::cast_scan(test::drawn_flat(), truth, time, {}, random)).estimate;
  }
  EXPECT_LT(distance_between(estimate.map_from_robot, truth), 0.2);
}

TEST(Localizer, SurvivesAJumpOfTheOdometry) {
  Drive drive{test::drawn_flat()};
  Localizer localizer = localizer_at_start(small(), test::drawn_flat());
  for (int i = 0; i < 20; ++i) (void)drive.next(localizer);
  drive.jump_odometry();
  for (int i = 0; i < 20; ++i) {
    const TrackedScan tracked = drive.next(localizer);
    ASSERT_LT(distance_between(tracked.estimate.map_from_robot, drive.truth()), 0.2) << i;
    ASSERT_EQ(tracked.odometry_epoch, 1u);
  }
}

TEST(Localizer, SurvivesAClockThatFallsBack) {
  Drive drive{test::drawn_flat()};
  Localizer localizer = localizer_at_start(small(), test::drawn_flat());
  for (int i = 0; i < 20; ++i) (void)drive.next(localizer);
  drive.fall_back(100.0);
  TrackedScan tracked;
  for (int i = 0; i < 20; ++i) tracked = drive.next(localizer);
  EXPECT_LT(distance_between(tracked.estimate.map_from_robot, drive.truth()), 0.2);
}

/// M_k with its patch, as the map thread prepares it.
MapRevision revision_of(std::uint32_t number, const OccupancyGrid& before, const OccupancyGrid& after,
                        bool with_patch) {
  MapRevision revision;
  revision.number = number;
  revision.map = std::make_shared<const OccupancyGrid>(after);
  revision.changes = changes_between(before, after);
  if (with_patch) revision.field_patch = prepared_field_patch(small(), after, revision.changes);
  return revision;
}

TEST(Localizer, GivesTheSameAnswersWhetherARevisionComesAsPatchOrIsRebuilt) {
  OccupancyGrid changed = test::drawn_flat();
  test::fill_box(changed, {5.0, 0.0}, {5.6, 0.7}, CellState::kOccupied);
  const auto run = [&](bool with_patch, std::uint32_t number) {
    Drive drive{changed};
    Localizer localizer = localizer_at_start(small(), test::drawn_flat());
    std::vector<double> numbers;
    for (int i = 0; i < 40; ++i) {
      if (i == 20) localizer.apply(revision_of(number, test::drawn_flat(), changed, with_patch));
      const Estimate estimate = drive.next(localizer).estimate;
      EXPECT_EQ(estimate.revision, i < 20 ? 0u : number);
      numbers.insert(numbers.end(), {estimate.map_from_robot.x, estimate.map_from_robot.y, estimate.w_avg});
    }
    return numbers;
  };
  const auto patched = run(true, 1);
  EXPECT_EQ(patched, run(false, 1));
  EXPECT_EQ(patched, run(true, 7));  // a gap in the numbers: rebuilt
}

TEST(Localizer, FitsBetterOnceTheMapFollowsTheWorld) {
  OccupancyGrid changed = test::drawn_flat();
  test::fill_box(changed, {5.0, 0.0}, {5.6, 0.9}, CellState::kOccupied);
  Drive drive{changed};
  Localizer localizer = localizer_at_start(small(), test::drawn_flat());
  double before = 0.0;
  for (int i = 0; i < 8; ++i) before = drive.next(localizer).estimate.w_avg;
  localizer.apply(revision_of(1, test::drawn_flat(), changed, true));
  EXPECT_GT(drive.next(localizer).estimate.w_avg, before + 0.03);
}

TEST(Localizer, UsesOnlyAsManyBeamsAsAsked) {
  LocalizerParams params = small();
  params.beams = 30;
  Drive drive{test::drawn_flat()};
  Localizer localizer = localizer_at_start(params, test::drawn_flat());
  TrackedScan tracked;
  for (int i = 0; i < 60; ++i) tracked = drive.next(localizer);
  EXPECT_LT(distance_between(tracked.estimate.map_from_robot, drive.truth()), 0.15);
}

}  // namespace
}  // namespace deltamap::localization
