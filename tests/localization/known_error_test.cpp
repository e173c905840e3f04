// SPDX-License-Identifier: Apache-2.0
// The estimate says how far it may be off: the truth lies in its ellipse about as often as it should, and where a
// corridor shows no end the ellipse grows along it. And what wheels lose or make up is found again.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "tests/support/scans/cast_scan.hpp"

namespace deltamap::localization {
namespace {

constexpr double kBetweenScansS = 0.2;
constexpr double kStepM = 0.08;
constexpr double kInside95 = 5.991;  // χ², two degrees of freedom

/// Two metres wide and 40 m long, with niches near its ends; a laser of 8 m sees none of them from the middle. Beams
/// end at a cell's face, contours lie in its middle: opposite walls even that out.
OccupancyGrid corridor() {
  OccupancyGrid map{{840, 80, 0.05, {-21.0, -2.0}}, CellState::kOccupied};
  test::fill_box(map, {-20.0, -1.0}, {20.0, 1.0}, CellState::kFree);
  for (const double x_m : {-18.0, -15.0, 14.0, 17.0}) {
    test::fill_box(map, {x_m, -1.5}, {x_m + 1.0, 1.5}, CellState::kFree);
  }
  return map;
}

class DriveThrough {
 public:
  explicit DriveThrough(std::uint64_t seed)
      : localizer_{{}, std::make_shared<const OccupancyGrid>(corridor()), particles::InitialPose{truth_}, seed},
        random_{seed} {}

  Estimate next() {
    time_ += duration_from_seconds(kBetweenScansS);
    truth_ = truth_ * Pose2{kStepM, 0.0, 0.0};
    odom_ = odom_ * Pose2{kStepM + random_.normal(0.004), 0.0, random_.normal(0.001)};
    Odometry odometry;
    odometry.time = time_;
    odometry.odom_from_robot = odom_;
    localizer_.observe(odometry);
    return localizer_.observe(test::cast_scan(world_, truth_, time_, {.max_range_m = 8.0, .noise_m = 0.008}, random_))
        .estimate;
  }
  void lose(double way_m) { odom_ = odom_ * Pose2{way_m, 0.0, 0.0}; }
  [[nodiscard]] const Pose2& truth() const { return truth_; }
  [[nodiscard]] double error_m(const Estimate& estimate) const {
    return distance_between(estimate.map_from_robot, truth_);
  }
  [[nodiscard]] bool is_inside(const Estimate& estimate) const {
    const Eigen::Vector2d off = estimate.map_from_robot.position() - truth_.position();
    const Eigen::Matrix2d covariance = estimate.covariance.topLeftCorner<2, 2>();
    return off.dot(covariance.inverse() * off) <= kInside95;
  }

 private:
  OccupancyGrid world_ = corridor();
  Pose2 truth_{-18.5, 0.0, 0.0};
  Pose2 odom_;
  Timestamp time_ = timestamp_from_ns(1'700'000'000'000'000'000);
  Localizer localizer_;
  Random random_;
};

TEST(KnownError, HoldsTheTruthInTheEllipseOfItsEstimate) {
  int inside = 0;
  int scans = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    DriveThrough drive{seed};
    while (drive.truth().x < 18.0) {
      inside += drive.is_inside(drive.next()) ? 1 : 0;
      ++scans;
    }
  }
  EXPECT_GT(inside, 0.85 * scans);
}

TEST(KnownError, GrowsAlongACorridorThatShowsNoEnd) {
  DriveThrough drive{1};
  double along_early_m = 0.0;
  double along_late_m = 0.0;
  double across_late_m = 0.0;
  while (drive.truth().x < 5.0) {
    const Estimate estimate = drive.next();
    if (drive.truth().x < -11.0) along_early_m = std::sqrt(estimate.covariance(0, 0));
    along_late_m = std::sqrt(estimate.covariance(0, 0));
    across_late_m = std::sqrt(estimate.covariance(1, 1));
  }
  EXPECT_GT(along_late_m, 1.5 * along_early_m);
  EXPECT_GT(along_late_m, 5.0 * across_late_m);
}

TEST(KnownError, ShrinksToTheScansOwnWhereTheEndComesIntoView) {
  DriveThrough drive{1};
  Estimate estimate;
  while (drive.truth().x < 16.0) estimate = drive.next();
  EXPECT_LT(std::sqrt(estimate.covariance(0, 0)), 0.03);
  EXPECT_LT(drive.error_m(estimate), 0.05);
}

TEST(WheelSlip, IsFoundAgainWhereScansShowIt) {
  for (const double lost_m : {0.3, -0.3}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      DriveThrough drive{seed};
      while (drive.truth().x < 12.0) (void)drive.next();
      drive.lose(lost_m);
      Estimate estimate;
      while (drive.truth().x < 17.5) estimate = drive.next();
      EXPECT_LT(drive.error_m(estimate), 0.06) << lost_m << ' ' << seed;
    }
  }
}

TEST(WheelSlip, IsFoundAgainWhereItIsSpreadOverASecond) {
  for (const double lost_m : {0.3, -0.3}) {
    DriveThrough drive{2};
    while (drive.truth().x < 12.0) (void)drive.next();
    Estimate estimate;
    for (int i = 0; i < 5; ++i) {
      drive.lose(lost_m / 5.0);
      estimate = drive.next();
    }
    while (drive.truth().x < 17.5) estimate = drive.next();
    EXPECT_LT(drive.error_m(estimate), 0.06) << lost_m;
  }
}

}  // namespace
}  // namespace deltamap::localization
